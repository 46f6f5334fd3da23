-- pinball.lua - a pinball table that plays itself.
-- Shows: flippers (hinges with limits, driven by motors that a script reverses), a plunger on a spring,
-- bumpers that kick what strikes them (on_hit), lanes that count (sensors), a gate that is passed one
-- way only (edit_contact).
scene { title = "Pinball", description = "Flippers, bumpers, lanes and a plunger.", gravity = {0, -5}, duration = 60,
        seed = 11, dt = 1/120 }
camera { fit = {{-3.6, -0.4}, {3.9, 9.4}}, at = 7.6, trail = 0.5 }

local rail = material { name = "rail", friction = 0.1, restitution = 0.4 }
local rubber = material { name = "rubber", friction = 0.3, restitution = 0.6 }
local steel = material { name = "steel", density = 50, friction = 0.05, restitution = 0.3 }

-- The frame: round on top, a lane for the plunger on the right, slopes towards the flippers.
local arc = {}
for i = 0, 16 do
    local a = math.pi * i / 16
    arc[#arc + 1] = { 0.2 + 3.4 * math.cos(a), 5.6 + 3.4 * math.sin(a) }
end
local shell = { {3.6, -0.2} }
for _, p in ipairs(arc) do shell[#shell + 1] = p end
shell[#shell + 1] = { -3.2, -0.2 }
body { name = "frame", type = "static", material = rail, color = "#4a5568", chain(shell),
       polygon {{-3.2, 2.6}, {-3.2, 1.4}, {-1.35, 1.4}}, polygon {{2.9, 2.6}, {1.05, 1.4}, {2.9, 1.4}},
       box { 0.1, 5.2, at = {2.95, 2.6} } }

-- A gate over the lane lets the ball out and not in again: a contact edit, before the solver sees it.
body { name = "gate", type = "static", capsule { 0.8, 0.05 }, at = {3.25, 5.5}, angle_deg = 35, material = rail,
       color = "#5b8fbf" }
edit_contact { a = "ball", b = "gate", function(ball, _, contact)
    local _, vy = ball:velocity()
    if vy > 0 then contact.enabled = false end
end }

-- Flippers: they turn about their outer end, between rest and struck.
local function flipper(name, x, sign)
    local bat = body { name = name, capsule { 0.85, 0.1, at = {sign * 0.42, 0} }, at = {x, 1.3}, angle = -sign * 0.35,
                       material = rubber, density = 40, color = "#cf6e73" }
    local low, high = -0.1, 0.9
    return bat, revolute { bat, at = {x, 1.3}, limits = sign > 0 and {low, high} or {-high, -low}, name = name,
                           motor = { speed = -sign * 12, torque = 300 } }
end
local left_bat, left = flipper("left flipper", -1.3, 1)
local right_bat, right = flipper("right flipper", 1.0, -1)

for i, p in ipairs { {-1.4, 6.2}, {1.1, 6.4}, {-0.2, 4.9} } do
    body { name = "bumper" .. i, type = "static", circle { 0.42 }, at = p, material = rubber, color = "#e9ca6b" }
end
for i, x in ipairs { -0.9, 0, 0.9 } do -- lanes on top
    body { name = "lane" .. i, type = "static", sensor = true, box { 0.5, 0.3 }, at = {x, 7.7}, color = "#74b083" }
end

-- The plunger is drawn back, and let go: its spring throws the ball up the lane.
local plunger = body { name = "plunger", box { 0.5, 0.3 }, at = {3.28, 0.9}, mass = 1, material = rail, color = "#9b86bd" }
local pull = prismatic { plunger, axis = {0, 1}, limits = {-0.8, 0}, name = "plunger",
                         spring = { frequency = 8, damping = 0.3 } }
local ball = body { name = "ball", circle { 0.16 }, at = {3.28, 1.4}, material = steel, color = "#2d3748" }
local drain = body { name = "drain", type = "static", sensor = true, box { 6, 0.3 }, at = {-0.2, 0.1}, color = "#cf6e73" }

local released = 0
local function launch(t) released = t + 0.6 end -- drawn back until then
on_enter { a = drain, b = ball, function()
    score("lost", score("lost") + 1)
    ball:teleport(3.28, 1.4)
    ball:set_velocity(0, 0)
    launch(time())
end }
launch(0)

every_step(function(t)
    if t < released then plunger:apply_force(0, -2500) end
    -- A flipper strikes when the ball is above it and near.
    local x, y = ball:position()
    local near = y < 1.75 and y > 0.7
    left:set_motor_speed(near and x > -1.2 and x < -0.1 and 25 or -12)
    right:set_motor_speed(near and x < 0.9 and x > -0.3 and -25 or 12)
end)
on_hit { a = ball, b = "bumper*", speed = 0.2, function(_, _, blow)
    score("points", score("points") + 10)
    ball:apply_impulse(-blow.nx * 2.2 * ball:mass(), -blow.ny * 2.2 * ball:mass())
end }
on_enter { a = "lane*", b = ball, function() score("points", score("points") + 50) end }

expect { "the plunger gets the ball onto the table", at = 3, body = "ball", x = {-3.2, 2.9} }
expect { "the ball stays on the table", always = true, body = "ball", x = {-3.3, 3.7}, y = {-0.2, 9.2} }
expect { "flippers keep their limits", always = true, joint = "left flipper", joint_value = {-0.16, 0.96} }
expect { "flippers keep their hinges", always = true, max_joint_error = 0.05 }
expect { "there is a score", score = "points", value = {50, 1e6} }
