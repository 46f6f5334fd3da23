-- mass_sizes.lua - boxes of 1, 2, 4, 8, 16 and 32 dm, the larger on the smaller: masses 1 to 1024 (AVBD: Stack Ratio).
-- Fails: softness; AVBD shows it as the scene that others fail. Right: it stands: the middle of each is over the smallest.
scene { title = "The larger on the smaller", duration = 5 }
body { type = "static", box { 40, 1 }, at = {0, -0.5} }
local y, size = 0, 0.1
for i = 1, 6 do
    body { name = "box" .. i, box { size, size }, at = {0, y + size / 2}, density = 100 }
    y, size = y + size, size * 2
end
expect { "the largest stands", from = 0.1, body = "box6", x = {-0.05, 0.05}, y = {4.65, 4.701}, angle = {-0.02, 0.02} }
expect { "the smallest holds", from = 0.1, body = "box1", x = {-0.01, 0.01}, y = {0.045, 0.051} }
