-- asteroids.lua - a ship among rocks in a world without edges: what leaves at one side comes in at the other.
-- Shows: wrap_x and wrap_y; contacts, shots and the question for the nearest rock go over the edge like everything.
scene { title = "Asteroids", description = "A ship shoots rocks to pieces in a world that wraps around.",
        gravity = {0, 0}, wrap_x = 32, wrap_y = 18, duration = 25, seed = 11, sleep = false }
camera { at = 6, trail = 0.6 }

local stone = material { name = "stone", density = 1, friction = 0, restitution = 1 }
local colors = { "#718096", "#a0724a", "#8a6d3b", "#6b7a5e" }
local smallest, made, left = 0.42, 0, 0

-- Round about: a polygon of 7 to 10 corners, each as far from the middle, unevenly spaced.
local function rock(x, y, radius, vx, vy, spin)
    made, left = made + 1, left + 1
    local corners, points = random_int(7, 10), {}
    for i = 1, corners do
        local angle = 2 * math.pi * (i + random(-0.25, 0.25)) / corners
        points[i] = {radius * math.cos(angle), radius * math.sin(angle)}
    end
    local b = body { name = ("rock_%d"):format(made), polygon(points), at = {x, y}, velocity = {vx, vy},
                     spin = spin, material = stone, color = colors[made % #colors + 1], continuous = true }
    b.user.radius = radius
    return b
end

for i = 0, 7 do
    local angle = 2 * math.pi * i / 8
    rock(11 * math.cos(angle), 6.6 * math.sin(angle), random(0.9, 1.5), random(-3, 3), random(-2, 2), random(-1, 1))
end

local ship = body { name = "ship", polygon { {0.7, 0}, {-0.5, 0.45}, {-0.5, -0.45} }, at = {0, 0},
                    velocity = {6, 3.5}, material = stone, color = "#2b6cb0", label = "ship" }

-- Every 0.3 s a shot at the nearest rock, over the edge if that is shorter: `nearest` answers with the
-- image beside the ship.
local shots = 0
every(0.3, function(t)
    if t < 3 then return end
    local px, py = ship:position()
    local found, x, y = nearest { at = {px, py}, within = 12, ignore = ship }
    if not found or found:name():sub(1, 4) ~= "rock" then return end
    local dx, dy = x - px, y - py
    local d = math.sqrt(dx^2 + dy^2)
    if d < 1.2 then return end
    shots = shots + 1
    local shot = body { name = ("shot_%d"):format(shots), circle { 0.12 }, at = {px + dx / d, py + dy / d},
                        velocity = {30 * dx / d, 30 * dy / d}, material = stone, color = "#c53030", continuous = true }
    shot.user.till = t + 0.8
end)

every_step(function(t)
    for i = math.max(1, shots - 4), shots do
        local shot = find(("shot_%d"):format(i))
        if shot and shot.user.till < t then shot:destroy() end
    end
end)

score("broken", 0)
score("crossings", 0)
on_contact { a = "shot*", b = "rock*", function(shot, hit)
    shot:destroy()
    local x, y = hit:position()
    local vx, vy = hit:velocity()
    local radius, spin = hit.user.radius / math.sqrt(2), hit:spin()
    hit:destroy()
    left = left - 1
    score("broken", score("broken") + 1)
    if radius < smallest then return end
    local angle = random(0, 2 * math.pi)
    local c, s = math.cos(angle), math.sin(angle)
    for side = -1, 1, 2 do
        rock(x + side * radius * 1.05 * c, y + side * radius * 1.05 * s, radius, vx + side * 1.5 * c,
             vy + side * 1.5 * s, spin)
    end
end }

local before = 0
every_step(function()
    local x = ship:position()
    if math.abs(x - before) > 16 then score("crossings", score("crossings") + 1) end
    before = x
end)

expect { "momentum is kept over the edges", till = 3, momentum_drift = 1e-5 }
expect { "so is energy", till = 3, energy_drift = 1e-3 }
-- The centre of mass is within; the place that a body tells, the origin of its corners, may be beyond.
expect { "rocks stay in the world", always = true, body = "rock*", x = {-16.6, 16.6}, y = {-9.6, 9.6} }
expect { "the ship stays in the world", always = true, body = "ship", x = {-16.6, 16.6}, y = {-9.6, 9.6} }
expect { "the ship has crossed the edge", score = "crossings", value = {2, 100} }
expect { "rocks are broken", score = "broken", value = {20, 1000} }
expect { "nothing is pressed into anything", from = 0.1, till = 3, max_penetration = 0.1 }
