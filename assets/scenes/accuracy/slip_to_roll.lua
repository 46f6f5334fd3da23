-- slip_to_roll.lua - a sliding disc begins to roll at t = v / (3 mu g) with 2 v / 3; a spinning one, set down, with w r /
-- 3.
-- Source: Coriolis, billiards, 1835; for discs, I = m r^2 / 2. Hard: the end of slipping lies within a step.
-- Aim: 1e-3 m.
scene { title = "From slipping to rolling", duration = 2, description = "Discs slip until they roll." }
local g, v, w, r, mu = 9.81, 10, 50, 0.25, 0.4
local m = material { friction = mu }
body { name = "ground", type = "static", box { 60, 1 }, at = {10, -0.5}, material = m }
body { name = "slider", circle { r }, at = {0, r}, velocity = {v, 0}, material = m, color = 1 }
body { name = "spinner", circle { r }, at = {-5, r}, spin = -w, material = m, color = 2 }
local stop, start = v / (3 * mu * g), w * r / (3 * mu * g)
exact { "slider", body = "slider", y = function() return r end, x = function(t)
    local u = math.min(t, stop)
    return v * u - mu * g * u * u / 2 + 2 / 3 * v * (t - u)
end }
exact { "spinner", body = "spinner", y = function() return r end, x = function(t)
    local u = math.min(t, start)
    return -5 + mu * g * u * u / 2 + w * r / 3 * (t - u)
end }
exact { "spin", body = "slider", spin = function() return -2 / 3 * v / r end, from = 1 }
expect { "the sliding disc", exact = "slider", tolerance = 7.9e-05 }
expect { "the spinning disc", exact = "spinner", tolerance = 8.1e-05 }
expect { "the spin of rolling", exact = "spin", tolerance = 0.00019 }
