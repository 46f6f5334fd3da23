-- drag_linear.lua - a fall with drag proportional to speed: v = vt (1 - e^(-ct)), y = -vt (t - (1 - e^(-ct)) / c), vt = g
-- / c.
-- Source: any textbook of mechanics. Hard: v / (1 + h c), which many engines do, is of first order.
scene { title = "Linear drag", duration = 5, description = "A fall with damping against its exponential." }
local g, c = 9.81, 0.8
local vt = g / c
body { name = "stone", circle { 0.3 }, damping = c }
exact { "place", body = "stone", x = function() return 0 end,
        y = function(t) return -vt * (t - (1 - math.exp(-c * t)) / c) end }
exact { "speed", body = "stone", vy = function(t) return -vt * (1 - math.exp(-c * t)) end }
expect { "the way", exact = "place", tolerance = 1.1e-05 }
expect { "the speed", exact = "speed", tolerance = 1.8e-06 }
