-- joints.lua - one joint of each kind but the cable (tackle.lua), side by side.
-- Shows: how each kind is written, what it allows and what it holds; the numbers are those of statics.
scene { title = "Joints", description = "Eleven kinds of joints, one of each.", duration = 6 }
camera { fit = {{-1.4, -5.3}, {19.6, 3.6}}, at = 2.4 }

local g, m = 9.81, 10
local function block(label, x, y, w, h)
    return body { name = label, label = label, box { w or 1, h or 0.5 }, at = {x, y}, mass = m, apart = "all" }
end

-- Upper row: a hinge driven by a motor, a slider on a spring, a weld, a wheel on its strut, a rod, a rope and a
-- spring in one chain, a pulley.
local fan = block("revolute", 0, 1.5, 1.6, 0.2)
local hinge = revolute { fan, motor = { speed = 2, torque = 50 }, name = "fan" }
prismatic { block("prismatic", 2.6, 1.5), axis = {0, 1}, limits = {-1, 0.5}, spring = { frequency = 2, damping = 0.5 }, name = "slider" }
weld { block("weld", 5.2, 1.5), at = {4.7, 1.5}, name = "weld" }
local cart = body { name = "cart", type = "static", box { 1.2, 0.2 }, at = {7.6, 2.2} }
wheel { cart, body { name = "wheel", label = "wheel", circle { 0.4 }, at = {7.6, 1.4}, mass = m, apart = "all" },
        spring = { frequency = 3, damping = 0.5 }, motor = { speed = -4, torque = 20 }, name = "strut" }
local rod, rope, spring = block("distance: rod", 10.4, 1.8), block("distance: rope", 10.4, 0.2), block("distance: spring", 10.4, -1.6)
distance { world, rod, at_a = {10.4, 3}, name = "rod" }
distance { rod, rope, limits = {0, 1.6}, name = "rope" }
distance { rope, spring, spring = { frequency = 2, damping = 0.3 }, name = "spring" }
local left, right = block("pulley", 13.4, -0.5), block("counterweight", 15.4, 1)
pulley { left, right, wheel_a = {13.4, 3}, wheel_b = {15.4, 3}, name = "pulley" }
local drawn = mouse { block("mouse", 17.6, 1.2), at = {17.3, 1.2}, max_force = 1000, name = "mouse" }

-- Lower row: a motor that holds a pose, two gears, a ratchet, friction.
motor { world, block("motor", 0.5, -2), angle = 0.5, offset = {0, 0.4}, max_force = 2000, max_torque = 500, name = "pose" }
local function disc(label, x, r)
    return body { name = label, label = label, circle { r }, at = {x, -3}, mass = m, apart = "all" }
end
local big, small = disc("gear", 3.6, 0.8), disc("pinion", 4.9, 0.4)
local drive = revolute { big, motor = { speed = 1, torque = 100 }, name = "drive" }
local driven = revolute { small, name = "driven" }
gear { drive, driven, ratio = 0.5, name = "gear" } -- half the radius: twice as fast, the other way
local ratcheted = disc("ratchet", 7.6, 0.7)
revolute { ratcheted, name = "axle" }
ratchet { ratcheted, pitch = radians(20), name = "ratchet" }
friction { block("friction", 15.4, -3.6), max_force = 2 * m * g, max_torque = 10, name = "pads" }

every_step(function(t)
    drawn:set_target(17.6 + 0.8 * math.cos(2 * t), 1.2 + 0.8 * math.sin(2 * t))
    ratcheted:apply_torque(20 * math.sin(6 * t)) -- to and fro: it turns one way only
end)
local back = 0
every_step(function() back = math.max(back, -ratcheted:spin()) end)

local function holds(joint, force)
    expect { joint .. " carries its load", at = 5, joint = joint, reaction = force, tolerance = 0.01 * force }
end
holds("slider", m * g)
holds("weld", m * g)
holds("pose", m * g)
holds("pads", m * g)
expect { "the weld holds the moment", at = 5, joint = "weld", reaction_torque = m * g * 0.5, tolerance = 0.5 }
expect { "rod, rope and spring carry what hangs below", at = 5.9, joint = "rod", reaction = 3 * m * g, tolerance = 1 }
expect { "equal loads balance on the pulley", at = 5, body = "pulley", y = -0.5, tolerance = 0.01 }
expect { "the pulley's rope pulls with one weight", at = 5, joint = "pulley", reaction = m * g, tolerance = 0.5 }
expect { "the fan turns at the motor's speed", at = 5, body = "revolute", spin = 2, tolerance = 0.01 }
expect { "the gears keep their ratio", always = true, joint = "gear", joint_value = 0, tolerance = 1e-3 }
expect { "the ratchet has turned one way", joint = "ratchet", joint_value = {0.5, 100} }
expect { "friction holds", at = 6, body = "friction", y = -3.6, tolerance = 0.01 }
expect { "nothing comes apart", from = 1, max_joint_error = 0.02 }
