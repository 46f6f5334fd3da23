-- stack_30_offset.lua - thirty boxes on one another, each put down a centimetre to the left or right of the last.
-- Fails: soft contacts lean it until it falls; qu3e #54 loses a stack of five when sleep is off. Right: it stands.
scene { title = "Stack of 30, offsets of 1 cm", duration = 20, sleep = false }
local n, offset = param("n", 30, 1, 100), param("offset", 0.01, 0, 0.4)
local wood = material { density = 600, friction = 0.6 }
body { type = "static", box { 60, 1 }, at = {0, -0.5}, material = wood }
for i = 1, n do body { name = "box" .. i, box { 1, 1 }, at = {i % 2 * offset, i - 0.5}, material = wood } end
expect { "it stands", always = true, body = "box*", x = {-0.3, 0.3}, angle = {-0.05, 0.05} }
expect { "the top is on top", body = "box" .. n, y = {n * 0.99 - 0.5, n - 0.49} }
