-- clock.lua - a pendulum clock: weight, drum, ratchet, gear train, escape wheel, Graham's anchor.
-- Shows: a machine whose parts touch. The escapement is plain contact between teeth and pallets; the train
-- is gear joints; the ratchet lets the weight be wound up (at 60 s) while the clock goes on.
-- Graham's pallets are arcs about the anchor's axis: a locked tooth neither drives nor brakes the
-- pendulum, so it keeps its own period 2 pi sqrt(I / (m g d)), whatever the weight.
scene { title = "Clock", description = "The pendulum's period is its own; the weight only keeps it going.",
        duration = 120, dt = 1/120, substeps = 8 }
camera { fit = {{-4.2, -3.6}, {3.2, 2.6}}, at = 32.2 }

local brass = material { name = "brass", friction = 0.02 }

-- The escape wheel turns clockwise: 12 thin teeth that lean forward on a disc.
local teeth, pitch = 12, radians(30)
local function polar(r, angle) return { r * math.cos(angle), r * math.sin(angle) } end
local wheel_shapes = { circle { 0.7 }, box { 0.06, 0.5, at = {0, 0.35}, collides = {} } }
for i = 0, teeth - 1 do
    local a = i * pitch
    wheel_shapes[#wheel_shapes + 1] = polygon { polar(1, a), polar(1, a + radians(1)), polar(0.66, a + radians(10)),
                                                polar(0.66, a + radians(3)) }
end
wheel_shapes.name, wheel_shapes.density, wheel_shapes.material = "escape wheel", 0.4, brass
wheel_shapes.color, wheel_shapes.angle = "#e9ca6b", radians(8)
local escape = body(wheel_shapes)
local arbor = revolute { escape, at = {0, 0}, name = "arbor" }

-- The anchor spans 3.5 teeth. Its axis is where the tangents of the wheel at both pallets meet.
local span = 3.5 * pitch / 2
local axis, reach = 1 / math.cos(span), math.tan(span)
local lift, lock, thick = radians(4), radians(1.5), radians(10) -- thick: of a pallet, along the wheel's rim
local anchor_shapes = {}
for side = -1, 1, 2 do -- -1: where teeth come in (left), 1: where they leave
    local function at_pallet(r, out) return polar(r, -math.pi / 2 + side * (math.pi / 2 - span + out)) end
    local inner, outer = reach - thick / 2, reach + thick / 2
    -- How far the slanted end lies from the rim at its inner and outer corner: a tooth climbs it.
    local out_inner, out_outer = side * lift / 2 - lock, -side * lift / 2 - lock
    local pieces, length = 5, radians(16)
    for i = 1, pieces do -- an arc, piece by piece
        local a, b = (i - 1) * length / pieces, i * length / pieces
        local ai, ao = i == 1 and out_inner or a, i == 1 and out_outer or a
        anchor_shapes[#anchor_shapes + 1] = polygon { at_pallet(inner, ai), at_pallet(outer, ao), at_pallet(outer, b),
                                                      at_pallet(inner, b) }
    end
    local hold = at_pallet(reach, length) -- an arm from the axis to the pallet; it touches nothing
    anchor_shapes[#anchor_shapes + 1] = polygon { {0, 0.12}, {0, -0.12}, hold, {1.02 * hold[1], 0.98 * hold[2] + 0.08},
                                                  collides = {} }
end
anchor_shapes[#anchor_shapes + 1] = box { 0.06, 4, at = {0, -2}, collides = {} }
anchor_shapes[#anchor_shapes + 1] = circle { 0.4, at = {0, -4}, density = 40, collides = {} }
anchor_shapes.name, anchor_shapes.at, anchor_shapes.angle = "pendulum", {0, axis}, radians(5)
anchor_shapes.density, anchor_shapes.material, anchor_shapes.color = 0.5, brass, "#5b8fbf"
local pendulum = body(anchor_shapes)
local air = 0.8 -- [N m] friction that the weight makes good; with less it swings so far that the pallets strike the disc
local pivot = revolute { pendulum, at = {0, axis}, name = "pivot", motor = { speed = 0, torque = air } }

-- The train: a weight on a drum, a ratchet from the drum to the great wheel, gears to the escape wheel.
local great = body { name = "great wheel", circle { 0.62 }, at = {-2.6, 0.6}, density = 2, collides = {}, color = "#cf8a4f" }
local drum = body { name = "drum", circle { 0.3 }, at = {-2.6, 0.6}, density = 2, collides = {}, color = "#a9744f" }
local load = body { name = "weight", box { 0.4, 0.6 }, at = {-2.9, -0.9}, mass = 5, collides = {}, color = "#4a5568" }
local great_arbor = revolute { great, at = {-2.6, 0.6}, name = "great arbor" }
local drum_arbor = revolute { drum, at = {-2.6, 0.6}, name = "drum arbor" }
local slide = prismatic { load, axis = {0, 1}, name = "slide", hidden = true }
gear { drum_arbor, slide, ratio = 1 / 0.3 } -- the cord: 0.3 m of travel a radian
ratchet { drum, great, pitch = 0.02, name = "click" }
gear { great_arbor, arbor, ratio = 1 / 6, name = "train" }

-- Every second passage of the pendulum through the middle ends a period.
local periods, first, last, side = {}, nil, nil, pendulum:angle() > 0
every_step(function(t)
    local now = pendulum:angle() > 0
    if now and not side then -- where between the last two steps the middle was passed
        local passed = t - pendulum:angle() / pendulum:spin()
        if last then periods[#periods + 1] = passed - last end
        first, last = first or passed, passed
        score("ticks", #periods)
    end
    side = now
end)

-- Wound up by hand from 60 to 66 s: the ratchet slips. Meanwhile a spring in the great wheel (Harrison's
-- maintaining power) drives the train as the weight did.
at(60, function() slide:set_motor(0.1, 500) end)
at(66, function() slide:set_motor() end)
every_step(function(t)
    if t > 60 and t < 66.1 then great:apply_torque(load:mass() * 9.81 * 0.3) end
end)

-- A compound pendulum of small swings; d: from the axis to the centre of mass.
local function theory()
    local x, y = pendulum:center()
    local m, d = pendulum:mass(), math.sqrt(x^2 + (y - axis)^2)
    return 2 * math.pi * math.sqrt((pendulum:inertia() + m * d^2) / (m * 9.81 * d))
end
expect { "it still goes", test = function() return #periods > 25, #periods, 25 end }
expect { "a tooth a period", test = function()
    local passed = -arbor:angle() / pitch
    return math.abs(passed - #periods) < 2, passed, #periods
end }
expect { "the period is constant", test = function()
    local low, high = math.huge, 0
    for i = 5, #periods do low, high = math.min(low, periods[i]), math.max(high, periods[i]) end
    return high / low < 1.02, high / low, 1.02
end }
expect { "it keeps its rate", test = function() -- ten periods early and ten late, the winding between
    local early, late = 0, 0
    for i = 1, 10 do early, late = early + periods[i], late + periods[#periods - 10 + i] end
    return math.abs(late / early - 1) < 0.005, late / early, 1.005
end }
expect { "it is the pendulum's own", test = function()
    local mean = (last - first) / #periods
    return math.abs(mean / theory() - 1) < 0.005, mean, theory()
end }
expect { "the wheel hardly turns back", always = true, body = "escape wheel", spin = {-50, 2} }
expect { "the train holds", always = true, max_joint_error = 0.05 }
