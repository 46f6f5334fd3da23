-- mass_two_feet.lua - a box of 20 m is dropped on two of 1 m (Solver2D: High Mass Ratio 2 and 3), on ground of a line.
-- Fails: the feet are pushed through the line. Right: they hold, and bear half each.
scene { title = "High Mass Ratio 2", duration = 5 }
body { type = "static", segment { {-40, 0}, {40, 0} } }
for i = -1, 1, 2 do body { name = "foot" .. i, box { 1, 1 }, at = {i * 9, 0.5}, density = 1000 } end
body { name = "giant", box { 20, 20 }, at = {0, 12}, density = 1000 }
expect { "no foot is pushed into the ground", from = 0.5, body = "foot*", y = {0.49, 0.51} }
expect { "the giant stands on them", from = 2, body = "giant", x = {-0.05, 0.05}, y = {10.97, 11.001}, angle = {-0.01, 0.01} }
expect { "it never sinks by 10 cm", always = true, body = "giant", y = {10.9, 12.01} }
