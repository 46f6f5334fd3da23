-- slide_stop.lua - a block slides to rest: d = v^2 / (2 mu g), t = v / (mu g).
-- Source: Coulomb 1785. Hard: the moment of stopping lies within a step; what friction pushes moves by h v.
-- Aim: 1e-3 m.
scene { title = "Stopping distance", duration = 3, description = "A block slides to rest." }
local g, v, mu = 9.81, 10, 0.4
local m = material { friction = mu }
body { name = "ground", type = "static", box { 40, 1 }, at = {10, -0.5}, material = m }
body { name = "block", box { 1, 0.5 }, at = {0, 0.25}, velocity = {v, 0}, material = m, fixed_rotation = true }
local stop = v / (mu * g)
exact { "way", body = "block", x = function(t)
    local u = math.min(t, stop)
    return v * u - mu * g * u * u / 2
end }
expect { "the way and the stop", exact = "way", tolerance = 0.00022 }
