-- wedges.lua - acute wedges at e = 0 are driven between two boxes that cannot give way, at 1 to 20 m/s.
-- Fails: recovery that stays as velocity throws them back. Right: at e = 0 nothing comes back faster than a
-- tenth of what came in, or than gravity makes it.
scene { title = "Wedges, e = 0", gravity = {0, 0}, duration = 3 }
local speeds, worst, was = { 1, 5, 10, 20 }, {}, {}
for k, v in ipairs(speeds) do
    local x = k * 4
    body { type = "static", box { 1, 2, at = {x - 0.6, -1} }, box { 1, 2, at = {x + 0.6, -1} } }
    body { name = "wedge" .. k, polygon {{0, 0}, {0.3, 2}, {-0.3, 2}}, at = {x, 0.3}, velocity = {0, -v} }
    worst[k] = 0
end
every_step(function()
    for k in ipairs(speeds) do
        local _, y = find("wedge" .. k):position()
        if was[k] then worst[k] = math.max(worst[k], (y - was[k]) * 60) end
        was[k] = y
    end
end)
for k, v in ipairs(speeds) do
    expect { ("the one at %g m/s does not come back"):format(v), test = function()
        return worst[k] <= 0.1 * v, worst[k], 0.1 * v
    end }
    expect { ("the one at %g m/s is stuck"):format(v), body = "wedge" .. k, y = {-0.9, -0.5}, x = {k * 4 - 0.1, k * 4 + 0.1} }
end
