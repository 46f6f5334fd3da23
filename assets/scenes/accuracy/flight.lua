-- flight.lua - a stone thrown, for 10 s: x = vx t, y = vy t - g t^2 / 2, angle = w t.
-- Source: Galilei 1638. Hard: semi-implicit steps are off by g h T / 2 (0.2 m here with 4 substeps), and 2,400 rounded
-- additions in float are off by millimetres.
scene { title = "Flight", duration = 10, description = "Free flight of 10 s against its parabola." }
local g, vx, vy, w = 9.81, 12, 30, 2
body { name = "stone", box { 0.6, 0.3 }, velocity = {vx, vy}, spin = w }
exact { "place", body = "stone", x = function(t) return vx * t end, y = function(t) return vy * t - g * t * t / 2 end }
exact { "turn", body = "stone", angle = function(t) return w * t end }
expect { "the parabola", exact = "place", tolerance = 7.6e-05 }
expect { "the turn", exact = "turn", tolerance = 3.6e-06 }
