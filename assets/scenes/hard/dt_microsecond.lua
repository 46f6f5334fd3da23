-- dt_microsecond.lua - a stack of five stands at 60 Hz, then one frame is taken in 16,000 steps of 1 us.
-- Fails: whoever ties stiffness to the step: a sink of millimetres, pushed out within microseconds, is a launch.
-- Right: nothing is to be seen. (A game does so when its clock jumps, or an editor that steps finely.)
scene { title = "Steps of 1 us", duration = 4 }
local n, parts = param("n", 5, 1, 20), param("parts", 16000, 1, 16000)
local stone = material { density = 1000, friction = 0.6 }
body { type = "static", box { 40, 1 }, at = {0, -0.5}, material = stone }
for i = 1, n do body { name = "box" .. i, box { 1, 1 }, at = {0, i - 0.5}, material = stone } end
at(1, function() split_step(parts) for i = 1, n do find("box" .. i):wake() end end)
at(1 + 1 / 60, function() split_step(1) end)

expect { "the top never hops", always = true, body = "box" .. n, y = {0, n - 0.5 + 1e-3} }
expect { "the stack stands", body = "box" .. n, x = {-1e-3, 1e-3}, y = {n - 0.5 - 0.005 * n, n - 0.5 + 1e-3} }
