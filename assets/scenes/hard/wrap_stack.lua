-- wrap_stack.lua - a pyramid across the edge of a world that wraps around at 20 m, and its twin in the middle.
-- Fails: places taken from the wrong side. Right: both stand, each box where its twin is.
scene { title = "A pyramid across the edge", duration = 5, wrap_x = 40 }
local rows = param("rows", 8, 1, 12)
local stone = material { density = 1000, friction = 0.6 }
for i = -2, 1 do body { type = "static", box { 10, 1 }, at = {i * 10 + 5, -0.5}, material = stone } end
local function box_at(name, x, y) return body { name = name, box { 1, 1 }, at = {x, y}, material = stone } end
for row = 1, rows do
    for i = 1, rows - row + 1 do
        local x, y = (i - (rows - row + 2) / 2) * 1.05, row - 0.5
        box_at(("middle%d_%d"):format(row, i), x, y)
        box_at(("edge%d_%d"):format(row, i), x < 0 and x + 20 or x - 20, y)
    end
end
expect { "the top in the middle stands", always = true, body = ("middle%d_1"):format(rows), x = {-0.02, 0.02},
         y = {(rows - 0.5) * 0.99, rows - 0.499} }
expect { "the top at the edge stands", always = true, body = ("edge%d_1"):format(rows), y = {(rows - 0.5) * 0.99, rows - 0.499} }
expect { "each is where its twin is", test = function()
    local off = 0
    for row = 1, rows do
        for i = 1, rows - row + 1 do
            local x, y = find(("middle%d_%d"):format(row, i)):position()
            local u, v = find(("edge%d_%d"):format(row, i)):position()
            local dx = math.abs(x - u)
            off = math.max(off, math.abs(dx - 20), math.abs(y - v))
        end
    end
    return off <= 0.005, off, 0.005
end }
