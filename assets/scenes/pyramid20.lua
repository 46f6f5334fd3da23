-- pyramid20.lua - a pyramid of boxes, 20 in the lowest row, placed at rest.
-- Shows: a resting pile of 210 bodies that neither creeps nor sinks.
scene { title = "Pyramid 20", description = "210 boxes, 20 in the lowest row, stand still.", duration = 10 }
camera { fit = {{-12, -1}, {12, 21}} }

local rows = 20
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

expect { "the pyramid stands", at = 10, max_speed = 0.02 }
expect { "the top stays on top", at = 10, body = ("box_%d_1"):format(rows), x = 0, y = rows - 0.5, tolerance = 0.05 }
expect { "little overlap at rest", at = 10, max_penetration = 0.01 }
