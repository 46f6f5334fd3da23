-- solar_system.lua - a sun, planets and a ring of small bodies, each pair by its own force (mutual{}), moved by an integrator
-- of fourth order: the momentum stays 0 but for rounding, and the sun is moved by its planets.
scene { title = "Solar system", gravity = {0, 0}, duration = 40,
        description = "A sun, planets, and a ring of asteroids." }
local G, sun = 1, 400
mutual { strength = G, softening = 0.1 }
orbits { order = 4 }
local momentum = 0
local function circle_at(name, r, angle, mass, radius, color, attraction)
    local c, s = math.cos(angle), math.sin(angle)
    local v = math.sqrt(G * (sun + mass) / r)
    local b = body { name = name, circle { radius, apart = "sky" }, mass = mass, attraction = attraction, at = {r * c, r * s},
                     velocity = {-v * s, v * c}, color = color }
    return b, -mass * v * s, mass * v * c
end
local px, py = 0, 0
local function planet(...)
    local _, x, y = circle_at(...)
    px, py = px + x, py + y
end
planet("inner", 4, 0.3, 0.4, 0.22, 5, 1)
planet("blue", 7, 2.1, 1, 0.32, 1, 1)
planet("red", 10, 4.0, 0.6, 0.26, 2, 1)
planet("giant", 18, 5.4, 2, 0.75, 3, 1)
for i = 1, 60 do
    planet("stone" .. i, 12.6 + 0.9 * random(), i * math.pi / 30, 1e-4, 0.07, "#9a8f80", 0)
end
body { name = "sun", circle { 1.1 }, mass = sun, attraction = 1, velocity = {-px / sun, -py / sun}, color = "#ffd257" }
camera { fit = {{-20, -19}, {20, 19}}, at = 9, trail = 3 }
expect { "nobody pushes himself", momentum_drift = 1e-5 }
expect { "energy", energy_drift = 1e-4 }
