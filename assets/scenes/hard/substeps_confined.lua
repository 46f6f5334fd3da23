-- substeps_confined.lua - more substeps must not make it worse: discs in a box with too little room for them, at 16
-- substeps. Fails: whoever grows stiffer with every substep: calm at 8, 1.3 m/s at 16, 7 m/s at 32. Right: the discs
-- share the overlap and lie still. With 4 substeps: confined.lua.
-- lint: allow overlap: it begins so on purpose
scene { title = "Confined, 16 substeps", substeps = 16, gravity = {0, 0}, duration = 6, seed = 3 }
local n = param("n", 15, 2, 30)
local half = 0.4 * n -- discs of diameter 1
body { type = "static", box { 2 * half + 2, 1, at = {0, -half - 0.5} }, box { 2 * half + 2, 1, at = {0, half + 0.5} },
       box { 1, 2 * half, at = {-half - 0.5, 0} }, box { 1, 2 * half, at = {half + 0.5, 0} } }
local discs, was, fastest = {}, {}, 0
for i = 0, n - 1 do
    for j = 0, n - 1 do
        discs[#discs + 1] = body { circle { 0.5 }, at = {(i - (n - 1) / 2) * 0.72, (j - (n - 1) / 2) * 0.72} }
        was[#discs] = {discs[#discs]:position()}
    end
end

-- The fastest that any was within a step, by its places.
every_step(function()
    fastest = 0
    for i, d in ipairs(discs) do
        local x, y = d:position()
        fastest = math.max(fastest, math.abs(x - was[i][1]) * 60, math.abs(y - was[i][2]) * 60)
        was[i] = {x, y}
    end
end)
expect { "they come to rest", from = 4, test = function() return fastest <= 0.01, fastest, 0.01 end }
expect { "nobody leaves the box", always = true, test = function()
    local most = 0
    for _, d in ipairs(discs) do
        local x, y = d:position()
        most = math.max(most, math.abs(x), math.abs(y))
    end
    return most <= half, most, half
end }
