-- confined.lua - 15 by 15 discs in a box that has room for 12 by 12 (Box2D's and Solver2D's Confined): no place without
-- overlap exists. Fails: XPBD and solvers with velocity in their recovery never come to rest. Right: the discs share
-- the overlap and lie still. More substeps: substeps_confined.lua.
-- lint: allow overlap: it begins so on purpose
-- watchdog: allow energy-jump, runaway-speed, sinking: it begins with an overlap that nothing can end
scene { title = "Confined", gravity = {0, 0}, duration = 6, seed = 3 }
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
