-- substeps_stack.lua - a stack of 20 that was placed at rest, at 64 substeps: who pays more must not get less.
-- Fails: engines whose contacts grow stiffer with every substep, and friction that anchors anew each substep.
-- Right: it stands as at 4.
scene { title = "A stack, 64 substeps", duration = 5, substeps = 64, sleep = false }
local n = param("n", 20, 1, 60)
local stone = material { density = 1000, friction = 0.6 }
body { type = "static", box { 40, 1 }, at = {0, -0.5}, material = stone }
for i = 1, n do body { name = "box" .. i, box { 1, 1 }, at = {0, i - 0.5}, material = stone } end
expect { "the top is where it was", always = true, body = "box" .. n, y = {n - 0.51, n - 0.499} }
expect { "nothing walks", body = "box*", x = {-1e-3, 1e-3}, angle = {-1e-3, 1e-3} }
