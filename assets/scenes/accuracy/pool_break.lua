-- pool_break.lua - a cue ball at 6 m/s breaks ten balls that lie 4 mm apart, a little off the middle: velocities after it,
-- against the same blows one after another by events (in this file), over the cue ball's speed.
-- Source: laws of impact (Huygens 1669), by events (Alder and Wainwright 1959). Hard: some 15 blows within a few steps,
-- each at the normal of its moment; errors grow from blow to blow.
-- Aim: 0.02.
scene { title = "Pool break", gravity = {0, 0}, duration = 0.5, description = "Ten balls, each blow at its moment." }
local r, gap, v = 0.0286, 0.004, 6
local ivory = material { friction = 0, restitution = 1, density = 1000 }
-- The same by events: discs of radius r fly straight until the next pair meets, and exchange what they have along the line of
-- centres. Independent of the engine, exact but for rounding.
local function by_events(discs, r, till)
    local t = 0
    while true do
        local first, one, two = till - t, nil, nil
        for i = 1, #discs do
            for k = i + 1, #discs do
                local a, b = discs[i], discs[k]
                local x, y, u, w = b.x - a.x, b.y - a.y, b.vx - a.vx, b.vy - a.vy
                local xu, uu = x * u + y * w, u * u + w * w
                local root = xu * xu - uu * (x * x + y * y - 4 * r * r)
                if xu < 0 and root > 0 then
                    local when = (-xu - math.sqrt(root)) / uu
                    if when < first then first, one, two = when, a, b end
                end
            end
        end
        for _, d in ipairs(discs) do d.x, d.y = d.x + first * d.vx, d.y + first * d.vy end
        if not one then return discs end
        t = t + first
        local nx, ny = (two.x - one.x) / (2 * r), (two.y - one.y) / (2 * r)
        local j = (two.vx - one.vx) * nx + (two.vy - one.vy) * ny
        one.vx, one.vy, two.vx, two.vy = one.vx + j * nx, one.vy + j * ny, two.vx - j * nx, two.vy - j * ny
    end
end
local discs = { { x = -0.5, y = 0.006, vx = v, vy = 0 } }
local d = 2 * r + gap
for row = 0, 3 do
    for k = 0, row do
        discs[#discs + 1] = { x = row * d * math.sqrt(3) / 2, y = (k - row / 2) * d, vx = 0, vy = 0 }
    end
end
for i, b in ipairs(discs) do
    body { name = "ball" .. i, circle { r }, at = {b.x, b.y}, velocity = {b.vx, b.vy}, material = ivory, sleep = false }
end
local truth = by_events(discs, r, 0.5)
exact { "velocities", at = 0.5, value = function() return 0 end, measure = function()
    local worst = 0
    for i, b in ipairs(truth) do
        local vx, vy = find("ball" .. i):velocity()
        worst = math.max(worst, math.sqrt((vx - b.vx) * (vx - b.vx) + (vy - b.vy) * (vy - b.vy)) / v)
    end
    return worst
end }
exact { "energy", at = 0.5, value = function() return 1 end, measure = function()
    return energy() / (find("ball1"):mass() * v * v / 2)
end }
expect { "the velocities", exact = "velocities", tolerance = 0.005 }
expect { "the energy", exact = "energy", tolerance = 5.3e-08 }
