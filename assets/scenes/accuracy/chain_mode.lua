-- chain_mode.lua - two masses on two rods swing in their slow mode: w^2 = (2 - sqrt 2) g / l, the lower angle sqrt 2 times
-- the upper.
-- Source: Daniel Bernoulli 1733; Landau and Lifshitz, Mechanics, 24. Hard: joints must not damp; amplitude 0.02 rad keeps
-- the share of what is not linear below 1e-4.
-- Aim: 1e-2 of the amplitude.
scene { title = "Slow mode", duration = 12, description = "Two masses swing together for five periods." }
local g, l, a = 9.81, 1, 0.02
local w = math.sqrt((2 - math.sqrt(2)) * g / l)
local x1, y1 = l * math.sin(a), -l * math.cos(a)
local b = math.sqrt(2) * a
local upper = body { name = "upper", circle { 0.1 }, at = {x1, y1}, mass = 1, inertia = 1e-6, apart = "all", sleep = false }
local lower = body { name = "lower", circle { 0.1 }, at = {x1 + l * math.sin(b), y1 - l * math.cos(b)}, mass = 1,
        inertia = 1e-6, apart = "all", sleep = false }
distance { world, upper, at_a = {0, 0} }
distance { upper, lower }
exact { "upper", scale = a, measure = function()
    local x, y = upper:position()
    return math.atan(x, -y)
end, value = function(t) return a * math.cos(w * t) end }
expect { "five periods", exact = "upper", tolerance = 0.0024 }
