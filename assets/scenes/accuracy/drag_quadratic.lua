-- drag_quadratic.lua - a fall with drag a = g - g (v / vt)^2 by field{}: y = -(vt^2 / g) ln cosh(g t / vt).
-- Source: any textbook of mechanics. Hard: the force depends on the velocity that it changes.
scene { title = "Quadratic drag", duration = 5, description = "A fall to terminal velocity." }
local g, vt = 9.81, 15
body { name = "stone", circle { 0.3 } }
field { body = "stone", function(x, y, vx, vy) return 0, -g / (vt * vt) * math.abs(vy) * vy end }
local function lncosh(u) return u + math.log((1 + math.exp(-2 * u)) / 2) end
exact { "place", body = "stone", x = function() return 0 end, y = function(t) return -vt * vt / g * lncosh(g * t / vt) end }
expect { "the way", exact = "place", tolerance = 7.6e-06 }
