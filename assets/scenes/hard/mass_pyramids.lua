-- mass_pyramids.lua - three pyramids of ten rows; instead of the topmost box a block of 100, 200, 300 times the mass is
-- dropped 2 m (Solver2D: High Mass Ratio 1). Fails: light boxes are squashed. Right: the blow may throw boxes about,
-- but none ends inside another, below the ground, or far away.
scene { title = "High Mass Ratio 1", duration = 6 }
local rows = param("rows", 8, 2, 20)
local wood = material { density = 100, friction = 0.6 }
body { type = "static", box { 200, 2 }, at = {0, -1}, material = wood }
for k = -1, 1 do
    for row = 1, rows do
        for i = 1, rows - row + 1 do
            body { name = row == rows and "block" .. k + 2 or ("box%d_%d_%d"):format(k, row, i), box { 1, 1 }, material = wood,
                   at = {k * 30 + (i - (rows - row + 2) / 2) * 1.05, row - 0.5 + (row == rows and 2 or 0)},
                   density = row == rows and 100 * (k + 2) * 100 or 100 }
        end
    end
end
expect { "nothing is pushed into the ground", always = true, body = "box*", y = {0.4, 1e4} }
expect { "no block falls through the ground", always = true, body = "block*", y = {0.4, rows + 2} }
expect { "nothing is shot up", always = true, body = "box*", y = {-1e4, rows + 2.5} }
for k = -1, 1 do
    expect { ("boxes under %d : 1 stay within 15 m"):format(100 * (k + 2)), always = true, body = ("box%d_*"):format(k),
             x = {k * 30 - 15, k * 30 + 15} }
end
