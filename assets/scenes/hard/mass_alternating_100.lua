-- mass_alternating_100.lua - ten boxes of 1 and 100 kg in turn, from the light one up (PhysX #21: 100 : 1 collapses; in
-- Plumb 10 : 1 is the most, in Box2D 3). Right: they stand.
-- lint: allow mass-ratio: that is what it asks about
scene { title = "Alternating masses 100 : 1", duration = 10 }
local n, ratio = param("n", 10, 2, 40), param("ratio", 100, 1, 1e6)
body { type = "static", box { 40, 1 }, at = {0, -0.5} }
for i = 1, n do body { name = "box" .. i, box { 1, 1 }, at = {0, i - 0.5}, mass = i % 2 == 0 and ratio or 1 } end
expect { "the top stands", always = true, body = "box" .. n, x = {-0.02, 0.02}, y = {(n - 0.5) * 0.99, n - 0.499} }
expect { "nothing leans", body = "box*", angle = {-0.02, 0.02} }
