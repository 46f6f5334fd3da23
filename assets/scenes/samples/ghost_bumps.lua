-- ghost_bumps.lua - discs, boxes, rounded boxes and capsules roll and slide over floors of tiles that lie flush: boxes of
-- 1 m, lines, and one chain. Without friction each arrives at the speed that it had, at the height that it had.
scene { title = "Ghost bumps", duration = 3 }
camera { fit = {{-13, -2}, {21, 14}}, at = 1.5, trail = 1 }
local ice = material { friction = 0 }
local things = { circle { 0.3 }, box { 0.6, 0.6 }, box { 0.5, 0.5, round = 0.05 }, capsule { 0.6, 0.3 } }
local v, kinds = 10, { "boxes", "lines", "a chain" }
for f = 1, 3 do
    for k = 1, 4 do
        local y, shapes, points = 1.3 * (4 * (f - 1) + k - 1), {}, {}
        for i = 0, 31 do
            local x = -12 + i
            if f == 1 then shapes[#shapes + 1] = box { 1, 0.2, at = {x + 0.5, y - 0.1} } end
            if f == 2 then shapes[#shapes + 1] = segment { {x, y}, {x + 1, y} } end
            points[#points + 1] = {x, y}
        end
        if f == 3 then shapes[1] = chain(points) end
        for _, s in ipairs(shapes) do body { type = "static", material = ice, s } end
        body { name = ("thing%d_%d"):format(f, k), things[k], at = {-11, y + 0.3}, velocity = {v, 0}, material = ice, color = k }
        expect { ("thing %d on %s keeps its height"):format(k, kinds[f]), always = true, body = ("thing%d_%d"):format(f, k), y = y + 0.3, tolerance = 2e-3 }
    end
end
for f = 1, 3 do
    expect { ("all arrive, on %s"):format(kinds[f]), body = ("thing%d_*"):format(f), x = -11 + 3 * v, vx = v, tolerance = 0.01 }
    expect { ("none turns, on %s"):format(kinds[f]), always = true, body = ("thing%d_*"):format(f), angle = 0, tolerance = 1e-3 }
end
