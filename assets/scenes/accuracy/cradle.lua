-- cradle.lua - Newton's cradle: five balls on rods, 1 mm apart, one let go at 0.5 rad. Equal balls exchange velocities, so
-- after half a period of the pendulum the last one stands at 0.5 rad and the others hang still. T = 2 pi sqrt(L / g) /
-- agm(1, cos(start / 2)).
-- Source: Mariotte 1673; Herrmann and Seitz, Am. J. Phys. 50 (1982) 977. Hard: five joints and a wave of blows in one
-- step.
-- Aim: 1e-2 m.
scene { title = "Newton's cradle", duration = 4, description = "One ball in, one ball out." }
local g, l, r, gap, start = 9.81, 1, 0.1, 0.001, 0.5
local steel = material { friction = 0, restitution = 1 }
local d = 2 * r + gap
for i = 1, 5 do
    local a = i == 1 and -start or 0
    local ball = body { name = "ball" .. i, circle { r }, at = {i * d + l * math.sin(a), -l * math.cos(a)}, material = steel,
            sleep = false, color = i }
    distance { world, ball, at_a = {i * d, 0} }
end
local a, b = 1, math.cos(start / 2)
for _ = 1, 6 do a, b = (a + b) / 2, math.sqrt(a * b) end
local period = 2 * math.pi * math.sqrt(l / g) / a
exact { "last", body = "ball5", x = function() return 5 * d + l * math.sin(start) end,
        y = function() return -l * math.cos(start) end, at = period / 2 }
exact { "third", body = "ball3", x = function() return 3 * d end, y = function() return -l end, at = period / 2 }
exact { "back", body = "ball1", x = function() return d - l * math.sin(start) end,
        y = function() return -l * math.cos(start) end, at = period }
expect { "the last ball stands at 0.5 rad", exact = "last", tolerance = 7.4e-05 }
expect { "the third hangs still", exact = "third", tolerance = 5.8e-05 }
expect { "the first is back", exact = "back", tolerance = 0.0002 }
