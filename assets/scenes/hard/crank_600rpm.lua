-- crank_600rpm.lua - a crank of 20 cm, a rod of 60 cm and a piston, driven at 600 turns a minute: 60 degrees a step.
-- Fails: soft joints and anchors frozen over the step: the rod opens by 10 % of the crank (Box2D 50 %).
-- Right: a rigid mechanism: the piston's place follows from the crank's angle.
scene { title = "Crank at 600 rpm", gravity = {0, 0}, duration = 4 }
local rpm = param("rpm", 600, 1, 6000)
local r, l = 0.2, 0.6
local crank = body { name = "crank", box { 2 * r, 0.05 }, at = {0, 0}, mass = 5, apart = "engine" }
local rod = body { name = "rod", box { l, 0.04 }, at = {r + l / 2, 0}, mass = 1, apart = "engine" }
local piston = body { name = "piston", box { 0.2, 0.2 }, at = {r + l, 0}, mass = 1, apart = "engine" }
local axle = revolute { world, crank, at = {0, 0}, motor = { speed = 0, torque = 1e5 } }
revolute { crank, rod, at = {r, 0} }
revolute { rod, piston, at = {r + l, 0} }
prismatic { world, piston, axis = {1, 0} }
every_step(function(t) axle:set_motor(math.min(t, 1) * rpm * 2 * math.pi / 60, 1e5) end) -- up to speed in a second

-- How far the piston is from where the crank's angle has it [m].
local off = 0
every_step(function(t)
    local angle = crank:angle()
    local sine = r / l * math.sin(angle)
    local x = piston:position()
    off = math.max(off, math.abs(x - r * math.cos(angle) - l * math.sqrt(1 - sine * sine)))
end)
expect { "the piston follows the crank within 1 %", test = function() return off <= 0.01 * r, off / r, 0.01 end }
expect { "no pin opens by 2 mm", always = true, max_joint_error = 0.002 }
expect { "the piston stays in its bore", always = true, body = "piston", y = {-0.002, 0.002}, angle = {-0.01, 0.01} }
