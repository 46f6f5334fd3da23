-- bounce_elastic.lua - a ball that falls 2 m at e = 1 bounces for 30 s: v^2 / 2 + g y stays, and so do the times of its
-- blows.
-- Source: conservation of energy. Hard: each blow lies within a step; half a step of gravity too much or too little adds
-- up.
-- Aim: 1e-4 of the energy; 1e-2 m.
scene { title = "Elastic ball", duration = 30, description = "A ball at e = 1 for 30 s." }
local g, h, r = 9.81, 2, 0.25
local steel = material { friction = 0, restitution = 1 }
body { name = "ground", type = "static", box { 10, 1 }, at = {0, -0.5}, material = steel }
local ball = body { name = "ball", circle { r }, at = {0, h + r}, material = steel, sleep = false }
local fall = math.sqrt(2 * h / g)
exact { "height", body = "ball", x = function() return 0 end, y = function(t)
    local u = (t + fall) % (2 * fall) - fall -- from the apex
    return r + h - g * u * u / 2
end }
exact { "energy", scale = g * h, value = function() return g * h end, measure = function()
    local _, y = ball:position()
    local v = ball:speed()
    return v * v / 2 + g * (y - r)
end }
expect { "every height", exact = "height", tolerance = 1.4e-05 }
expect { "the energy", exact = "energy", tolerance = 1.8e-07 }
