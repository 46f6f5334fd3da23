-- there_and_back.lua - 20 elastic discs without friction among walls; after 1.5 s they are where the same blows one after
-- another lead (in this file), all velocities are turned round, and after 3 s each is where it began.
-- Source: laws of impact are symmetric in time; by events (Alder and Wainwright 1959). Hard: each blow's error grows by that
-- of way over radius.
-- Aim: 1e-2 m.
scene { title = "There and back", gravity = {0, 0}, duration = 3, description = "Discs return by the way that they came." }
local steel = material { friction = 0, restitution = 1 }
for i, w in ipairs { {-3.25, 0, 0.5, 7}, {3.25, 0, 0.5, 7}, {0, -3.25, 7, 0.5}, {0, 3.25, 7, 0.5} } do
    body { name = "wall" .. i, type = "static", box { w[3], w[4] }, at = {w[1], w[2]}, material = steel }
end
local start, discs = {}, {}
for i = 1, 20 do
    local x, y = (i - 1) % 5 * 1.2 - 2.4, (i - 1) // 5 * 1.5 - 2.25
    start[i] = { x, y }
    discs[i] = { x = x, y = y, vx = 1.3 * math.cos(i * i), vy = 1.3 * math.sin(i * i) }
    body { name = "disc" .. i, circle { 0.25 }, at = {x, y}, velocity = {1.3 * math.cos(i * i), 1.3 * math.sin(i * i)},
            material = steel, sleep = false }
end
at(1.5, function()
    for i = 1, 20 do
        local b = find("disc" .. i)
        local vx, vy = b:velocity()
        b:set_velocity(-vx, -vy)
    end
end)
-- Discs of radius r fly straight until the next blow: of two, which exchange what they have along the line of centres, or of
-- one and a wall at the distance w. Independent of the engine, exact but for rounding.
local function by_events(discs, r, w, till)
    local t = 0
    while true do
        local first, one, two, axis = till - t, nil, nil, nil
        for i, a in ipairs(discs) do
            for _, side in ipairs { "x", "y" } do
                local speed = a["v" .. side]
                local when = ((speed > 0 and w - r or r - w) - a[side]) / speed
                if speed ~= 0 and when < first then first, one, two, axis = when, a, nil, "v" .. side end
            end
            for k = i + 1, #discs do
                local b = discs[k]
                local x, y, vx, vy = b.x - a.x, b.y - a.y, b.vx - a.vx, b.vy - a.vy
                local xv, vv = x * vx + y * vy, vx * vx + vy * vy
                local root = xv * xv - vv * (x * x + y * y - 4 * r * r)
                if xv < 0 and root > 0 then
                    local when = (-xv - math.sqrt(root)) / vv
                    if when < first then first, one, two = when, a, b end
                end
            end
        end
        for _, d in ipairs(discs) do d.x, d.y = d.x + first * d.vx, d.y + first * d.vy end
        if not one then return discs end
        t = t + first
        if two then
            local nx, ny = (two.x - one.x) / (2 * r), (two.y - one.y) / (2 * r)
            local j = (two.vx - one.vx) * nx + (two.vy - one.vy) * ny
            one.vx, one.vy, two.vx, two.vy = one.vx + j * nx, one.vy + j * ny, two.vx - j * nx, two.vy - j * ny
        else
            one[axis] = -one[axis]
        end
    end
end
local turn = by_events(discs, 0.25, 3, 1.5)
exact { "there", at = 1.5, unit = "m", value = function() return 0 end, measure = function()
    local worst = 0
    for i, d in ipairs(turn) do
        local x, y = find("disc" .. i):position()
        worst = math.max(worst, math.sqrt((x - d.x) * (x - d.x) + (y - d.y) * (y - d.y)))
    end
    return worst
end }
exact { "back", at = 3, unit = "m", value = function() return 0 end, measure = function()
    local worst = 0
    for i = 1, 20 do
        local x, y = find("disc" .. i):position()
        x, y = x - start[i][1], y - start[i][2]
        worst = math.max(worst, math.sqrt(x * x + y * y))
    end
    return worst
end }
exact { "energy", scale = 1, value = function() return 1 end, measure = function()
    return energy() / (20 * find("disc1"):mass() * 1.3 * 1.3 / 2)
end }
expect { "there", exact = "there", tolerance = 5.1e-06 }
expect { "all are back", exact = "back", tolerance = 1.1e-05 }
expect { "the energy", exact = "energy", tolerance = 2.5e-08 }
