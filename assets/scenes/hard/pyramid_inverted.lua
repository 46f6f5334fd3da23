-- pyramid_inverted.lua - a pyramid that stands on its tip: one box below, ten above, each row borne by the one under it.
-- Fails: it tips at once to the side that is solved last. Right: the outer boxes of each row hang over, and it falls
-- open evenly to both sides: left and right halves are mirror images for the first second.
scene { title = "Inverted pyramid", duration = 1 }
local rows = param("rows", 6, 2, 12)
local stone = material { density = 1000, friction = 0.8 }
body { type = "static", box { 60, 1 }, at = {0, -0.5}, material = stone }
for row = 1, rows do
    for i = 1, row do
        body { name = ("box%d_%d"):format(row, i), box { 1, 1 }, at = {i - (row + 1) / 2, row - 0.5}, material = stone }
    end
end
expect { "both halves are mirror images", always = true, test = function()
    local off = 0
    for row = 1, rows do
        for i = 1, row do
            local x, y = find(("box%d_%d"):format(row, i)):position()
            local u, v = find(("box%d_%d"):format(row, row + 1 - i)):position()
            off = math.max(off, math.abs(x + u), math.abs(y - v))
        end
    end
    return off <= 0.01, off, 0.01
end }
