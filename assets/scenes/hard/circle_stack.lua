-- circle_stack.lua - ten discs on one another, each on a single point (Solver2D: Circle Stack). It is in balance, not
-- stable. Fails: solvers that round to one side tip it at once. Right: symmetric input stays symmetric: it stands.
scene { title = "Circle stack", duration = 6, sleep = false }
local n = param("n", 10, 1, 30)
body { type = "static", box { 40, 1 }, at = {0, -0.5} }
for i = 1, n do body { name = "disc" .. i, circle { 0.5 }, at = {0, i - 0.5} } end
expect { "it stands", always = true, body = "disc*", x = {-1e-3, 1e-3} }
expect { "it does not sink", body = "disc" .. n, y = {n * 0.995 - 0.5, n - 0.499} }
