-- bounce_series.lua - a ball falls 5 m at e = 0.8: apexes 5 e^2n, at rest after sqrt(2 h / g) (1 + e) / (1 - e) = 9.087 s.
-- Source: Styer, The bouncing ball, MAA JOMA. Hard: bounces come ever faster; heights after a step's rest of gravity.
-- Aim: 1e-3 m.
scene { title = "Bounces", duration = 9.5, description = "A ball bounces lower and lower until it rests." }
local g, h, e, r = 9.81, 5, 0.8, 0.25
local rubber = material { friction = 0, restitution = e }
body { name = "ground", type = "static", box { 10, 1 }, at = {0, -0.5}, material = rubber }
body { name = "ball", circle { r }, at = {0, h + r}, material = rubber, sleep = false }
exact { "height", body = "ball", x = function() return 0 end, y = function(t)
    local fall = math.sqrt(2 * h / g)
    if t < fall then return r + h - g * t * t / 2 end
    t = t - fall
    local v = e * g * fall
    while v > 1e-6 do
        if t < 2 * v / g then return r + v * t - g * t * t / 2 end
        t, v = t - 2 * v / g, e * v
    end
    return r
end }
expect { "every height", exact = "height", tolerance = 5.9e-05 }
