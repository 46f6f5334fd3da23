-- pyramid100.lua - a pyramid of boxes, 100 in the lowest row, placed at rest.
-- Shows: a pile of 5050 bodies that settles under its own weight, by half a metre, and then rests.
scene { title = "Pyramid 100", description = "5050 boxes, 100 in the lowest row, stand still.", duration = 12 }
camera { fit = {{-56, -1}, {56, 101}} }

local rows = 100
local stone = material { name = "stone", density = 1000, friction = 0.6 }
body { name = "ground", type = "static", box { 4 * rows, 1 }, at = {0, -0.5}, material = stone }
for row = 1, rows do
    for i = 1, rows - row + 1 do
        body {
            name = ("box_%d_%d"):format(row, i),
            box { 1, 1 },
            at = {(i - (rows - row + 2) / 2) * 1.05, row - 0.5},
            material = stone,
            color = row % 10,
        }
    end
end

expect { "the pyramid stands", at = 12, max_speed = 0.2 }
expect { "the top stays on top", at = 12, body = ("box_%d_1"):format(rows), x = 0, y = rows - 1, tolerance = 0.5 }
expect { "little overlap at rest", at = 12, max_penetration = 0.03 }
