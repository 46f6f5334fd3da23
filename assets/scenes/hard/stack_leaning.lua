-- stack_leaning.lua - ten bricks, each 8 cm to the right of the one below: the weight of each part is over its base.
-- By statics n bricks of width 1 stand if n d / 2 < 1 / 2, so d < 10 cm; beyond, they fall: the second stack.
-- Fails: soft contacts press in at the edge and tip over early. Right: 8 cm stands, 14 cm falls.
scene { title = "Leaning stacks", duration = 10 }
local n = param("n", 10, 2, 40)
local brick = material { density = 2000, friction = 0.8 }
body { type = "static", box { 60, 1 }, at = {0, -0.5}, material = brick }
for i = 1, n do
    body { name = "a" .. i, box { 1, 0.4 }, at = {-5 + (i - 1) * 0.72 / (n - 1), 0.4 * i - 0.2}, material = brick }
    body { name = "b" .. i, box { 1, 0.4 }, at = {5 + (i - 1) * 1.26 / (n - 1), 0.4 * i - 0.2}, material = brick }
end
expect { "the first stands", body = "a" .. n, tolerance = 0.05, position = {-5 + 0.72, 0.4 * n - 0.2} }
expect { "the first is straight", body = "a*", angle = {-0.02, 0.02} }
expect { "the second falls", body = "b" .. n, y = {0, 0.3 * n} }
