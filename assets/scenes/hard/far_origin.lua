-- far_origin.lua - a stack and a chain 1 km, and again 10 km from the origin (Solver2D: Far Stack, Far Chain).
-- In float places are 1 mm apart at 10 km. Fails: engines that add small motions to large places: Solver2D keeps them
-- apart for that. Right: both stand within the grid of numbers; `--precision far` and double: as at the origin.
scene { title = "Far from the origin", duration = 6 }
local n = param("n", 10, 2, 40)
for k, x in ipairs { 1000, 10000 } do
    local y = -x * 0.6
    body { type = "static", box { 40, 1 }, at = {x, y - 0.5} }
    for i = 1, n do body { name = ("box%d_%d"):format(k, i), box { 1, 1 }, at = {x - 4, y + i - 0.5} } end
    local last = body { type = "static", box { 0.2, 0.2 }, at = {x + 4, y + 10} }
    for i = 1, n do
        local link = body { name = ("link%d_%d"):format(k, i), box { 0.5, 0.2 },
                            at = {x + 3.75 + i * 0.5, y + 10}, apart = "chain" }
        revolute { last, link, at = {x + 3.5 + i * 0.5, y + 10}, name = ("pin%d_%d"):format(k, i) }
        last = link
    end
    local where = ("%g km"):format(x / 1000)
    expect { "the stack stands at " .. where, always = true, body = ("box%d_%d"):format(k, n), x = {x - 4.02, x - 3.98},
             y = {y + (n - 0.5) * 0.99, y + n - 0.49} }
    expect { "the chain is whole at " .. where, from = 0.1, joint = ("pin%d_*"):format(k), max_joint_error = 0.02 }
    expect { "the chain swings at " .. where, at = 1, body = ("link%d_%d"):format(k, n), y = {y + 3, y + 9} }
end
