-- air_drag.lua - drag of still air against its closed forms. Three balls are dropped: the light one soon falls at its top
-- speed sqrt(m g / drag); one has damping besides, c v + drag v^2 / m = g. Shots of equal speed fly less far the more drag they
-- have; a puck that slides alone goes as v / (1 + k v t).
scene { title = "Drag of still air", duration = 6,
        description = "Balls that fall at their top speeds, shots through the air, and one without air." }
local g = 9.81
local function tanh(x) return (math.exp(2 * x) - 1) / (math.exp(2 * x) + 1) end
local function top(k, c) return 2 * g / (c + math.sqrt(c * c + 4 * k * g)) end
local function dropped(name, x, mass, drag, c, color)
    return body { name = name, circle { 0.35, apart = "all" }, at = {x, 20}, mass = mass, drag = drag, damping = c, color = color }
end
dropped("light", -3, 1, 2, 0, 1)
dropped("damped", 0, 1, 2, 3, 2)
dropped("heavy", 3, 10, 2, 0, 3)
for i, drag in ipairs { 0, 0.02, 0.1, 0.5 } do
    body { name = "shot" .. i, circle { 0.3, apart = "all" }, at = {-22, -10}, velocity = {14, 20}, mass = 1, drag = drag, color = 3 + i }
end
body { name = "puck", circle { 0.3, apart = "all" }, at = {-22, -14}, velocity = {30, 0}, mass = 1, drag = 0.2, gravity_scale = 0, color = 8 }
camera { fit = {{-24, -16}, {24, 21}}, at = 3, trail = 4 }
local function falls(name, speed)
    expect { name .. " falls at its top speed", body = name, at = 3, min_speed = speed * (1 - 1e-4), max_speed = speed * (1 + 1e-4) }
end
falls("light", top(2, 0))
falls("damped", top(2, 3))
falls("heavy", top(0.2, 0) * tanh(g * 3 / top(0.2, 0)))
local slow = 30 / (1 + 0.2 * 30 * 3)
expect { "the puck is slowed as by the formula", body = "puck", at = 3, min_speed = slow * (1 - 1e-4), max_speed = slow * (1 + 1e-4) }
