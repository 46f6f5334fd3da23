-- copies_mirror.lua - a cluster of boxes is struck; on the other side the same in a mirror.
-- Fails: solvers whose result depends on left and right. Right: until rounding grows, mirror images.
scene { title = "Mirrored copies", duration = 2 }
local wood = material { density = 600, friction = 0.4 }
body { type = "static", box { 100, 1 }, at = {0, -0.5}, material = wood }
local pairs_of = {}
local function both(name, shape, x, y, vx, angle)
    local function one(s) return body { name = name .. (s > 0 and "r" or "l"), shape, at = {s * x, y}, angle = s * angle,
                                        velocity = {s * vx, 0}, material = wood } end
    pairs_of[#pairs_of + 1] = { one(1), one(-1) }
end
for row = 1, 5 do
    for i = 1, 6 - row do both(("box%d_%d"):format(row, i), box { 1, 1 }, 12 + (i - (7 - row) / 2) * 1.1, row - 0.5, 0, 0) end
end
both("shot", box { 0.8, 0.8 }, 4, 2.2, 12, 0.3)
local function apart()
    local off = 0
    for _, p in ipairs(pairs_of) do
        local x, y = p[1]:position()
        local u, v = p[2]:position()
        off = math.max(off, math.abs(x + u), math.abs(y - v))
    end
    return off
end
expect { "they agree within a centimetre", always = true, test = function() local d = apart() return d <= 0.01, d, 0.01 end }
