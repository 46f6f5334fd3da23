-- jenga.lua - a tower of 18 storeys seen from the side, three blocks a storey and one across in turn; the middle ones of
-- six storeys are drawn out, one after the other. Fails: towers that creep while they are played. Right: it stands.
scene { title = "Jenga", duration = 12 }
local storeys = param("storeys", 18, 2, 60)
local wood = material { density = 600, friction = 0.5 }
body { type = "static", box { 40, 1 }, at = {0, -0.5}, material = wood }
for s = 1, storeys do
    local y = (s - 0.5) * 0.3
    if s % 2 == 1 then
        for i = -1, 1 do body { name = ("block%d_%d"):format(s, i), box { 0.498, 0.3 }, at = {i * 0.5, y}, material = wood } end
    else
        body { name = "plank" .. s, box { 1.5, 0.3 }, at = {0, y}, material = wood }
    end
end
local drawn = 0
every(1, function()
    drawn = drawn + 1
    local b = drawn <= 6 and find(("block%d_0"):format(drawn * 2 + 1))
    if b then b:destroy() end
end)
local top = "plank" .. storeys // 2 * 2
local y = (storeys // 2 * 2 - 0.5) * 0.3
expect { "the tower stands", always = true, body = top, x = {-0.03, 0.03}, y = {y - 0.05, y + 0.005} }
expect { "it is upright", body = "plank*", angle = {-0.01, 0.01} }
