-- crane.lua - a tower crane sets a crate on a platform; beside it a builder's hoist runs over a pulley.
-- Shows: a trolley on a rail (prismatic, motor), a rope that is wound (distance, limits), a weld made and
-- undone by events, a pulley. Atwood: the hoist's loads move with a = g (m1 - m2) / (m1 + m2).
scene { title = "Crane", description = "A trolley, a winch, and a hoist over a pulley.", duration = 26 }
camera { fit = {{-9, -0.8}, {8.5, 9.4}}, at = 17 }

local g = 9.81
local concrete = material { name = "concrete", friction = 0.8 }
local oak = material { name = "oak", density = 100, friction = 0.8 }
body { name = "ground", type = "static", box { 60, 1, at = {0, -0.5} }, material = concrete }
body { name = "tower", type = "static", color = "#d69e2e", box { 0.5, 8.6, at = {-1, 4.3} }, box { 13.4, 0.35, at = {1, 8.8} },
       polygon {{-1.25, 8.9}, {-0.75, 8.9}, {-1, 9.4}}, category = "tower" }
body { name = "platform", type = "static", box { 2.4, 2, at = {6, 1} }, material = concrete }

-- The trolley runs below the jib, the hook hangs on it by a rope whose length the winch sets.
local trolley = body { name = "trolley", box { 0.9, 0.25 }, at = {1.5, 8.4}, mass = 150, ignores = "tower", color = "#5b8fbf" }
local rail = prismatic { trolley, axis = {1, 0}, limits = {-1, 5}, motor = { speed = 0, force = 4000 }, name = "rail" }
local length = 1.5
local hook = body { name = "hook", circle { 0.18 }, at = {1.5, 8.3 - length}, mass = 40, color = "#4a5568" }
local rope = distance { trolley, hook, at_a = {1.5, 8.3}, limits = {0, length}, name = "rope" }
local crate = body { name = "crate", box { 1.2, 1.2 }, at = {1.5, 0.6}, material = oak, color = "#cf8a4f" }

-- The winch winds at most 1 m/s; the trolley eases in and out, so that the load hardly swings.
local wanted = length
every_step(function(t)
    local most = 1.0 / 60
    length = length + math.max(-most, math.min(most, wanted - length))
    rope:set_limits(0, length)
    local begin, way, time = 13, 4.5, 7.6 -- [s], [m], [s]: twice the time of a swing
    local u = (t - begin) / time
    rail:set_motor_speed(u > 0 and u < 1 and 2 * way / time * math.sin(math.pi * u)^2 or 0)
end)
at(0.5, function() wanted = 7.2 end)
at(8, function() wanted = 3 end)
at(21, function() wanted = 6.5 end)

local grip
on_contact { a = hook, b = crate, function()
    if not grip and time() < 20 then grip = weld { hook, crate, at = {hook:position()}, name = "grip" } end
end }
on_contact { a = crate, b = "platform", function()
    if grip then grip:destroy() grip = nil wanted = 5 end
end }

-- The hoist: two buckets on one rope over two wheels.
local m1, m2 = 45, 30
local heavy = body { name = "heavy", box { 0.8, 0.8 }, at = {-6.5, 6}, mass = m1, color = "#74b083" }
local light = body { name = "light", box { 0.7, 0.7 }, at = {-4.5, 2}, mass = m2, color = "#9b86bd" }
pulley { heavy, light, wheel_a = {-6.5, 8.5}, wheel_b = {-4.5, 8.5}, name = "hoist" }

local a = g * (m1 - m2) / (m1 + m2)
expect { "the hoist moves as Atwood's machine", at = 1.5, body = "light", vy = a * 1.5, tolerance = 0.01 * a }
expect { "its rope pulls with 2 m1 m2 g / (m1 + m2)", at = 1, joint = "hoist", reaction = 2 * m1 * m2 * g / (m1 + m2), tolerance = 1 }
expect { "its rope keeps its length", till = 1.5, joint = "hoist", joint_value = 0, tolerance = 1e-3 }
expect { "the rope carries hook and crate", at = 12.9, joint = "rope", reaction = (40 + crate:mass()) * g, tolerance = 20 }
expect { "the load hangs still after the ride", at = 20.8, body = "crate", x = 6, tolerance = 0.1 }
expect { "the crate stands on the platform", body = "crate", position = {6, 2.6}, tolerance = 0.1 }
expect { "and lies still", body = "crate", max_speed = 0.02 }
expect { "the rope is never longer than wound", always = true, test = function()
    local over = rope:value() - length
    return over < 0.04, over, 0.04 -- wound at 1 m/s, it lags by 0.03 m
end }
