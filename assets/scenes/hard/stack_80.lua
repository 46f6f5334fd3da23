-- stack_80.lua - a tower of 80 boxes (Rapier's and Box2D's column). PGS needs 0.93 N^2 sweeps a digit: few reach it.
-- Fails: it buckles, or sinks into itself. Right: exactly upright, it stands; a centimetre a storey would be seen.
scene { title = "Tower of 80", duration = 8, sleep = false }
local n = param("n", 80, 1, 200)
local stone = material { density = 1000, friction = 0.6 }
body { type = "static", box { 60, 1 }, at = {0, -0.5}, material = stone }
for i = 1, n do body { name = "box" .. i, box { 1, 1 }, at = {0, i - 0.5}, material = stone } end
expect { "it stands", always = true, body = "box*", x = {-0.1, 0.1} }
expect { "it has not sunk by a hundredth", body = "box" .. n, y = {n * 0.99 - 0.5, n - 0.499} }
local was
at(5, function() was = select(2, find("box" .. n):position()) end)
expect { "it has come to rest within 5 s", test = function()
    local _, y = find("box" .. n):position()
    return math.abs(y - was) <= 1e-3, math.abs(y - was), 1e-3
end }
