-- tunnel_pairs.lua - pairs of discs and boxes, both dynamic, head on at 20 to 1000 m/s each.
-- Fails: Box2D and Rapier (#984) have no continuous collision between dynamic bodies. Right: they never change sides.
-- lint: allow fast-and-thin: fast things are what it asks
scene { title = "Bullets head on", gravity = {0, 0}, duration = 1 }
local count = 0
for _, v in ipairs { 20, 100, 200, 500, 1000 } do
    for j = 0, 3 do
        count = count + 1
        local shape = j % 2 == 0 and circle { 0.05 } or box { 0.1, 0.1 }
        body { name = "left" .. count, shape, at = {-3 - j * v / 240, count}, velocity = {v, 0} }
        body { name = "right" .. count, shape, at = {3, count}, velocity = {-v, 0} }
    end
end
expect { "none has changed sides", always = true, test = function()
    local passed = 0
    for i = 1, count do
        if not (select(1, find("left" .. i):position()) < select(1, find("right" .. i):position())) then passed = passed + 1 end
    end
    return passed == 0, passed, 0
end }
