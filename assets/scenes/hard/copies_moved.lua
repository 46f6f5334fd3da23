-- copies_moved.lua - a pyramid is struck at the origin and again 64 m and 1024 m to the right (powers of two: places
-- round alike). Fails: solvers that work on absolute places. Right: the copies agree until rounding grows.
scene { title = "Moved copies", duration = 1.5 }
local wood = material { density = 600, friction = 0.4 }
local moves, copies = { 0, 64, 1024 }, {}
for k, m in ipairs(moves) do
    copies[k] = {}
    body { type = "static", box { 40, 1 }, at = {m, -0.5}, material = wood }
    local function put(shape, x, y, vx)
        copies[k][#copies[k] + 1] = body { shape, at = {m + x, y}, velocity = {vx, 0}, material = wood }
    end
    for row = 1, 5 do
        for i = 1, 6 - row do put(box { 1, 1 }, (i - (7 - row) / 2) * 1.125, row - 0.5, 0) end
    end
    put(box { 0.75, 0.75 }, -8, 2.25, 12)
end
-- How far copy k is from the first [m].
local function apart(k)
    local off = 0
    for i, b in ipairs(copies[k]) do
        local x, y = b:position()
        local u, v = copies[1][i]:position()
        off = math.max(off, math.abs(x - moves[k] - u), math.abs(y - v))
    end
    return off
end
for k, limit in ipairs { 0, 0.01, 0.05 } do
    expect { ("the one at %g m agrees within %g m"):format(moves[k], limit), always = true, test = function()
        local off = apart(k)
        return off <= limit, off, limit
    end }
end
