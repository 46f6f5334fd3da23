-- stack_shaken.lua - stacks of five on a table that shakes by 1 cm once a second (0.04 g: statics tips them at 0.2 g), and
-- on one that falls away and rises by 20 cm at 0.4 g. Fails: stacks that walk or rock up. Right: they ride along.
scene { title = "Shaken stacks", duration = 20 }
local n, hertz = param("n", 5, 1, 12), param("hertz", 1, 0.1, 10)
local wood = material { density = 600, friction = 0.6 }
local aside = body { name = "aside", type = "kinematic", box { 6, 1 }, at = {-5, -0.5}, material = wood }
local up = body { name = "up", type = "kinematic", box { 6, 1 }, at = {5, -0.5}, material = wood }
for i = 1, n do
    body { name = "aside" .. i, box { 1, 1 }, at = {-5, i - 0.5}, material = wood }
    body { name = "up" .. i, box { 1, 1 }, at = {5, i - 0.5}, material = wood }
end
local rate = math.sqrt(0.4 * 9.81 / 0.2)
every_step(function(t)
    local next = t + 1 / 60
    aside:move_to(-5 + 0.01 * math.sin(2 * math.pi * hertz * next), -0.5)
    up:move_to(5, -0.7 + 0.2 * math.cos(rate * next))
end)
local off, low = 0, 0
every_step(function(t)
    if t < 1 then return end
    local tx = aside:position()
    local _, ty = up:position()
    for i = 1, n do
        local x = find("aside" .. i):position()
        local u, v = find("up" .. i):position()
        off = math.max(off, math.abs(x - tx))
        low = math.max(low, math.abs(v - ty - i), math.abs(u - 5))
    end
end)
expect { "nothing walks by 2 cm on the shaken table", test = function() return off <= 0.02, off, 0.02 end }
expect { "nothing hops by 2 cm on the rising table", test = function() return low <= 0.02, low, 0.02 end }
expect { "all are upright", always = true, body = "aside*", angle = {-0.02, 0.02} }
expect { "all stay upright", always = true, body = "up*", angle = {-0.02, 0.02} }
