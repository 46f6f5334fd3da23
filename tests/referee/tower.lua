-- tower.lua - boxes of a metre one upon the other, `n` of them, placed at rest: how far the top is from its place after 6 s,
-- as a share of the height. Right: it stands as it was placed.
scene { title = "Tower", duration = 6, sleep = false }
local n = param("n", 10, 1, 200)
local wood = material { density = 600, friction = 0.6 }
body { type = "static", box { 400, 1 }, at = {0, -0.5}, material = wood }
for i = 1, n do body { name = "box" .. i, box { 1, 1 }, at = {0, i - 0.5}, material = wood } end
expect { "its top is off by 1 % at most", test = function()
    local x, y = find("box" .. n):position()
    local off = math.sqrt(x * x + (y - n + 0.5) * (y - n + 0.5)) / n
    return off <= 0.01, off, 0.01
end }
