-- pyramid_100.lua - 5,050 boxes, 100 in the lowest row (Box2D's and Rapier's large pyramid), placed at rest.
-- Fails: it takes Plumb 14 s, Box2D 5.4 s to come to rest, and it leans by half a metre. Right: it lies from the first
-- step on: exact solvers have it within a second. Few steps here; a look at the end: `--set duration=20`.
scene { title = "Pyramid of 100", duration = 2 }
local rows = param("rows", 100, 1, 200)
local stone = material { density = 1000, friction = 0.6 }
body { type = "static", box { 4 * rows, 1 }, at = {0, -0.5}, material = stone }
for row = 1, rows do
    for i = 1, rows - row + 1 do
        body { name = ("box%d_%d"):format(row, i), box { 1, 1 }, material = stone,
               at = {(i - (rows - row + 2) / 2) * 1.05, row - 0.5} }
    end
end
local top, was = ("box%d_1"):format(rows), 0
at(1, function() was = select(2, find(top):position()) end)
expect { "at rest within a second", test = function()
    local _, y = find(top):position()
    return math.abs(y - was) <= 0.001 * rows, math.abs(y - was), 0.001 * rows
end }
expect { "it has not sunk by a hundredth", body = top, y = {rows * 0.99 - 0.5, rows - 0.49} }
expect { "it is upright", body = top, x = {-0.005 * rows, 0.005 * rows} }
