-- arch.lua - a semicircular arch of 20 stones of thickness `share` times the radius of its middle line: how far its crown is
-- down after 6 s, as a share of the radius. Right (Milankovitch): from 0.1075 on it stands, below it falls.
scene { title = "Arch", duration = 6, sleep = false }
local share, stones, R = param("share", 0.13, 0.05, 0.5), 20, 5
local stone = material { density = 2000, friction = 0.9 }
body { type = "static", box { 40, 1 }, at = {0, -0.5}, material = stone }
local inner, outer = R * (1 - share / 2), R * (1 + share / 2)
for i = 1, stones do
    local a, b = math.pi * (i - 1) / stones, math.pi * i / stones
    body { name = "stone" .. i, material = stone, polygon {
        {inner * math.cos(a), inner * math.sin(a)}, {outer * math.cos(a), outer * math.sin(a)},
        {outer * math.cos(b), outer * math.sin(b)}, {inner * math.cos(b), inner * math.sin(b)} } }
end
local crown = find("stone" .. stones // 2)
expect { "it stands if it should", test = function()
    local x, y = crown:position()
    local drop = math.max(0, -y / R)
    return (drop < 0.1) == (share > 0.1075), drop, 0.1
end }
