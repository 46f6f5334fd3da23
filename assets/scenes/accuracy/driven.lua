-- driven.lua - a damped oscillator driven near resonance, by field{}: x'' = -w^2 x - 2 d x' + f cos(p t). x = A cos(p t -
-- phi) + e^(-d t) (B cos(q t) + C sin(q t)), A = f / sqrt((w^2 - p^2)^2 + 4 d^2 p^2), q^2 = w^2 - d^2.
-- Source: Landau and Lifshitz, Mechanics, 26. Hard: phases of two frequencies for 10 s, a force that depends on time.
scene { title = "Driven oscillator", gravity = {0, 0}, duration = 10, description = "Transient and steady swing near resonance." }
local w, d, f, p = 8, 0.3, 4, 7.5
body { name = "mass", box { 0.4, 0.4 }, sleep = false }
field { body = "mass", function(x, y, vx, vy, t) return -w * w * x - 2 * d * vx + f * math.cos(p * t) end }
local q = math.sqrt(w * w - d * d)
local amplitude = f / math.sqrt((w * w - p * p) * (w * w - p * p) + 4 * d * d * p * p)
local phase = math.atan(2 * d * p, w * w - p * p)
local b = -amplitude * math.cos(phase)
local c = (d * b - amplitude * p * math.sin(phase)) / q
exact { "place", body = "mass", y = function() return 0 end, x = function(t)
    return amplitude * math.cos(p * t - phase) + math.exp(-d * t) * (b * math.cos(q * t) + c * math.sin(q * t))
end }
expect { "the swing", exact = "place", tolerance = 0.00064 }
