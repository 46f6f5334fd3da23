-- rush.lua - Rush of Solver2D: 400 discs, each pulled to the centre by 1000 N. Fails: friction by substep lets the heap
-- turn or boil. Right: a round heap that comes to rest.
scene { title = "Rush", gravity = {0, 0}, duration = 10 }
local n = param("n", 400, 10, 1000)
body { type = "static", circle { 0.5 } }
local discs, was, fastest = {}, {}, 0
for i = 0, n - 1 do
    local a, far = i * 2.39996, 8 + 0.06 * i
    discs[i + 1] = body { name = "disc" .. i, circle { 0.5 }, at = {far * math.cos(a), far * math.sin(a)}, density = 100 }
end
every_step(function()
    fastest = 0
    for i, d in ipairs(discs) do
        local x, y = d:position()
        local far = math.sqrt(x * x + y * y)
        if far > 0.01 then d:apply_force(-1000 * x / far, -1000 * y / far) end
        if was[i] then fastest = math.max(fastest, math.abs(x - was[i][1]) * 60, math.abs(y - was[i][2]) * 60) end
        was[i] = {x, y}
    end
end)
expect { "the heap rests", from = 9, test = function() return fastest <= 0.05, fastest, 0.05 end }
expect { "nobody is thrown out", from = 5, body = "disc*", x = {-20, 20}, y = {-20, 20} }
