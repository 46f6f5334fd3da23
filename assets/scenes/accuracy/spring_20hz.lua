-- spring_20hz.lua - an undamped spring of 20 Hz: x = A cos(w t); its amplitude, sqrt(x^2 + (v / w)^2), stays A.
-- Source: Hooke 1678. Hard: soft rows are implicit: they damp what swings within some substeps.
-- Places are exact; velocities are those of half a substep ago, so that with them the amplitude is off by x^2 / 8, x = w h.
scene { title = "Spring of 20 Hz", gravity = {0, 0}, duration = 3, description = "An undamped spring keeps its amplitude." }
local a, w = 0.2, 2 * math.pi * 20
local mass = body { name = "mass", box { 0.4, 0.4 }, at = {a, 0}, sleep = false }
prismatic { mass, at = {0, 0}, axis = {1, 0}, spring = { frequency = 20, damping = 0, rest = -a } }
exact { "amplitude", scale = a, at = 3, value = function() return a end, -- after sixty periods: a crest
        measure = function() return math.abs(mass:position()) end }
exact { "both", scale = a, at = 3, value = function() return a end, measure = function()
    local x, v = mass:position(), mass:velocity()
    return math.sqrt(x * x + v * v / (w * w))
end }
exact { "phase", body = "mass", x = function(t) return a * math.cos(w * t) end, y = function() return 0 end }
expect { "the amplitude", exact = "amplitude", tolerance = 3.2e-06 }
expect { "the amplitude with its velocity", exact = "both", tolerance = 1.7e-06 }
expect { "sixty periods", exact = "phase", tolerance = 2e-5 }
