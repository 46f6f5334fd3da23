-- size_huge.lua - a stack and a pyramid of 100 m blocks and a ball that rolls (Box2D advises 10 m at most).
-- Fails: recovery and stiffness in metres and seconds. Right: they stand as boxes of a metre do.
-- lint: allow units: it is about 100 m
scene { title = "Blocks of 100 m", duration = 4 }
local size, n = param("size", 100, 1, 1000), param("n", 10, 2, 40)
local wood = material { density = 600, friction = 0.6 }
body { type = "static", box { 200 * size, 10 * size }, at = {0, -5 * size}, material = wood }
for i = 1, n do body { name = "box" .. i, box { size, size }, at = {0, (i - 0.5) * size}, material = wood } end
for row = 1, n do
    for i = 1, n - row + 1 do
        body { name = ("stone%d_%d"):format(row, i), box { size, size }, material = wood,
               at = {(20 + (i - (n - row + 2) / 2) * 1.05) * size, (row - 0.5) * size} }
    end
end
local v = 2 * math.sqrt(size)
body { name = "ball", circle { size / 2 }, at = {-10 * size, size / 2}, velocity = {-v, 0}, spin = 2 * v / size, material = wood }
local tall = (n - 0.5) * size
expect { "the stack stands", always = true, body = "box" .. n, x = {-0.02 * size, 0.02 * size},
         y = {tall * 0.99, tall + 0.002 * size} }
expect { "the pyramid stands", always = true, body = ("stone%d_1"):format(n), y = {tall * 0.99, tall + 0.002 * size},
         x = {19.9 * size, 20.1 * size} }
expect { "the ball has rolled", body = "ball", x = -10 * size - 4 * v, tolerance = 0.05 * size, y = {0.49 * size, 0.501 * size} }
