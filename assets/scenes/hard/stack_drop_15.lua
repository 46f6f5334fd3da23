-- stack_drop_15.lua - Vertical Stack of Solver2D: 15 boxes, 1 cm offsets, dropped with gaps of 10 cm.
-- Fails: XPBD jitters. Right: it lands, and stands within some millimetres of where it fell.
scene { title = "Vertical Stack", duration = 10 }
local n, offset, gap = param("n", 15, 1, 60), param("offset", 0.01, 0, 0.4), param("gap", 0.1, 0, 1)
local wood = material { density = 600, friction = 0.3 }
body { type = "static", box { 60, 1 }, at = {0, -0.5}, material = wood }
for i = 1, n do
    body { name = "box" .. i, box { 1, 1 }, at = {i % 2 * offset, (i - 1) * (1 + gap) + 0.5 + gap}, material = wood }
end
expect { "it stands", from = 5, body = "box*", x = {-0.1, 0.1}, angle = {-0.02, 0.02} }
expect { "the top is on top", body = "box" .. n, y = {n * 0.995 - 0.5, n - 0.499} }
