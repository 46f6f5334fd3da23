-- conveyor.lua - a crate set on a belt of 3 m/s: it slips v / (mu g) long, over v^2 / (2 mu g), then goes with the belt.
-- Source: Coulomb 1785 in the belt's frame. Hard: friction that drives; a surface that moves while nothing does.
-- Aim: 1e-3 m.
scene { title = "Belt", duration = 2, description = "A belt brings a crate to its speed." }
local g, v, mu = 9.81, 3, 0.3
body { name = "belt", type = "static", box { 40, 1 }, at = {10, -0.5}, material = material { friction = mu, surface_speed = v } }
body { name = "crate", box { 0.5, 0.5 }, at = {0, 0.25}, material = material { friction = mu }, fixed_rotation = true }
local stop = v / (mu * g)
exact { "way", body = "crate", x = function(t)
    local u = math.min(t, stop)
    return mu * g * u * u / 2 + v * (t - u)
end }
expect { "the way", exact = "way", tolerance = 3.8e-05 }
