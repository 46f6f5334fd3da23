-- slow_body.lua - a free body at 0.04 m/s goes on: x = v t.
-- Source: Newton's first law. Hard: what is slower than a threshold is put to sleep after half a second.
scene { title = "Slow body", gravity = {0, 0}, duration = 10, description = "A free body at 0.04 m/s goes on." }
body { name = "puck", circle { 0.3 }, velocity = {0.04, 0} }
exact { "place", body = "puck", x = function(t) return 0.04 * t end, y = function() return 0 end }
expect { "uniform motion", exact = "place", tolerance = 2.9e-08 }
