-- dt_60_to_240.lua - a stack stands at 60 Hz; then the game runs at 240 Hz.
-- Fails: whoever ties the stiffness of contacts to the step, so that the sink stored at 60 Hz is set free by the
-- shorter step. Right: nothing is to be seen.
scene { title = "A stack, 60 Hz to 240 Hz", duration = 4 }
local n, parts = param("n", 10, 1, 50), param("parts", 4, 1, 1000)
local stone = material { density = 1000, friction = 0.6 }
body { type = "static", box { 40, 1 }, at = {0, -0.5}, material = stone }
for i = 1, n do body { name = "box" .. i, box { 1, 1 }, at = {0, i - 0.5}, material = stone } end
at(2, function() split_step(parts) for i = 1, n do find("box" .. i):wake() end end)

expect { "the top never hops", always = true, body = "box" .. n, y = {0, n - 0.5 + 1e-3} }
expect { "the top has not sunk", body = "box" .. n, y = {n - 0.5 - 0.005 * n, n - 0.5 + 1e-3} }
expect { "nothing went sideways", body = "box*", x = {-1e-3, 1e-3} }
