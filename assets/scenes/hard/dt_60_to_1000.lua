-- dt_60_to_1000.lua - a stack stands at 60 Hz; then steps are 1/1020 s, as in a replay or a careful solver.
-- Fails: whoever ties stiffness to the step: the stack is launched. Right: nothing is to be seen.
scene { title = "A stack, 60 Hz to 1000 Hz", duration = 4 }
local n, parts = param("n", 10, 1, 50), param("parts", 17, 1, 1000)
local stone = material { density = 1000, friction = 0.6 }
body { type = "static", box { 40, 1 }, at = {0, -0.5}, material = stone }
for i = 1, n do body { name = "box" .. i, box { 1, 1 }, at = {0, i - 0.5}, material = stone } end
-- It may have fallen asleep; whoever is woken must lie still as well.
at(2, function() split_step(parts) for i = 1, n do find("box" .. i):wake() end end)

expect { "the top never hops", always = true, body = "box" .. n, y = {0, n - 0.5 + 1e-3} }
expect { "nobody leaves the one below", always = true, test = function()
    local widest = 0
    for i = 2, n do
        local _, low = find("box" .. i - 1):position()
        local _, high = find("box" .. i):position()
        widest = math.max(widest, high - low - 1)
    end
    return widest <= 1e-3, widest, 1e-3
end }
expect { "the top has not sunk", body = "box" .. n, y = {n - 0.5 - 0.005 * n, n - 0.5 + 1e-3} }
