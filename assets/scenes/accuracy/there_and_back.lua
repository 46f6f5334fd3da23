-- there_and_back.lua - 20 elastic discs without friction among walls; after 1.5 s all velocities are turned round, and
-- after 3 s each is where it began, with the opposite velocity.
-- Source: laws of impact are symmetric in time. Hard: each blow's error grows by that of way over radius.
-- Aim: 1e-2 m.
scene { title = "There and back", gravity = {0, 0}, duration = 3, description = "Discs return by the way that they came." }
local steel = material { friction = 0, restitution = 1 }
for i, w in ipairs { {-3.25, 0, 0.5, 7}, {3.25, 0, 0.5, 7}, {0, -3.25, 7, 0.5}, {0, 3.25, 7, 0.5} } do
    body { name = "wall" .. i, type = "static", box { w[3], w[4] }, at = {w[1], w[2]}, material = steel }
end
local start = {}
for i = 1, 20 do
    local x, y = (i - 1) % 5 * 1.2 - 2.4, (i - 1) // 5 * 1.5 - 2.25
    start[i] = { x, y }
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
expect { "all are back", exact = "back", tolerance = 0.027 }
expect { "the energy", exact = "energy", tolerance = 7.4e-08 }
