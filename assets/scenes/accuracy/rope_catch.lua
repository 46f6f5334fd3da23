-- rope_catch.lua - a free mass comes to the end of its rope: what goes along the rope ends, v sin(angle) goes on round a
-- circle.
-- Source: Routh: an inelastic blow. Hard: the moment lies within a step; the rope must neither stretch nor bounce.
-- Aim: 1e-3 m.
scene { title = "Rope", gravity = {0, 0}, duration = 3, description = "A mass comes to the end of its rope." }
local v, y0, l = 3, 1, 2.5
local x0 = math.sqrt(l * l - y0 * y0)
local mass = body { name = "mass", circle { 0.1 }, at = {-2, y0}, velocity = {v, 0}, sleep = false }
distance { world, mass, at_a = {0, 0}, limits = {0, l} }
local taut, start, w = (x0 + 2) / v, math.atan(y0, x0), -v * y0 / (l * l)
exact { "place", body = "mass",
        x = function(t) return t < taut and -2 + v * t or l * math.cos(start + w * (t - taut)) end,
        y = function(t) return t < taut and y0 or l * math.sin(start + w * (t - taut)) end }
exact { "speed", unit = "m/s", from = 2, measure = function() return mass:speed() end, value = function() return v * y0 / l end }
expect { "the way", exact = "place", tolerance = 7.8e-06 }
expect { "the speed", exact = "speed", tolerance = 1.8e-05 }
