-- dt_longer.lua - the other way round: a stack that stands at 240 Hz goes on at 60 Hz and at 30 Hz.
-- Fails: whoever lets contacts grow soft with the step: the stack sinks in. Right: nothing is to be seen.
scene { title = "A stack, 240 Hz to 30 Hz", dt = 1 / 30, duration = 4 }
local n = param("n", 10, 1, 50)
local stone = material { density = 1000, friction = 0.6 }
body { type = "static", box { 40, 1 }, at = {0, -0.5}, material = stone }
for i = 1, n do body { name = "box" .. i, box { 1, 1 }, at = {0, i - 0.5}, material = stone } end
local function wake() for i = 1, n do find("box" .. i):wake() end end
split_step(8)
at(1.5, function() split_step(2) wake() end)
at(2.5, function() split_step(1) wake() end)

local top = "box" .. n
expect { "it stands at 240 Hz", at = 1.5, body = top, y = {n - 0.5 - 0.005 * n, n - 0.5 + 1e-3} }
expect { "it stands at 60 Hz", at = 2.5, body = top, y = {n - 0.5 - 0.005 * n, n - 0.5 + 1e-3} }
expect { "it stands at 30 Hz", body = top, y = {n - 0.5 - 0.005 * n, n - 0.5 + 1e-3} }
expect { "it never hops", always = true, body = top, y = {0, n - 0.5 + 1e-3} }
