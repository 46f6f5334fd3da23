-- spring_1hz.lua - an undamped spring of 1 Hz for ten periods: x = A cos(w t).
-- Source: Hooke 1678. Hard: the phase; a step of first order is late by a constant share.
scene { title = "Spring of 1 Hz", gravity = {0, 0}, duration = 10, description = "Ten periods of a spring." }
local a, w = 1, 2 * math.pi
local mass = body { name = "mass", box { 0.4, 0.4 }, at = {a, 0}, sleep = false }
prismatic { mass, at = {0, 0}, axis = {1, 0}, spring = { frequency = 1, damping = 0, rest = -a } }
exact { "place", body = "mass", x = function(t) return a * math.cos(w * t) end, y = function() return 0 end }
expect { "ten periods", exact = "place", tolerance = 1.7e-05 }
