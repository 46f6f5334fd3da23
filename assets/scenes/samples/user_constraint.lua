-- user_constraint.lua - a joint of one's own: a field hangs a box by two springs that pull and never push, as ropes do. It
-- swings, is damped and comes to rest where the springs bear its weight.
scene { title = "A joint by script", duration = 12 }
camera { fit = {{-4, -4}, {4, 4}}, at = 1.2, trail = 1 }
local m, k, c, rest = 3, 120, 10, 2.5
local it = body { name = "hung", box { 1.6, 0.4 }, at = {0, 2.5}, mass = m, color = 1, angular_damping = 1 }
local eyes = { {-2, 3}, {2, 3} }
for _, e in ipairs(eyes) do body { type = "static", circle { 0.08 }, at = e, collides = {}, color = "#8792a2" } end
field { body = "hung", function(x, y, vx, vy)
    local ax, ay = 0, 0
    for _, e in ipairs(eyes) do
        local dx, dy = x - e[1], y - e[2]
        local far = math.sqrt(dx * dx + dy * dy)
        local pull = k * (far - rest) + c * (vx * dx + vy * dy) / far
        if far > rest and pull > 0 then ax, ay = ax - pull * dx / far / m, ay - pull * dy / far / m end
    end
    return ax, ay, 0
end }
-- At rest at depth d below the eyes: 2 k (s - rest) d / s = m g, s^2 = 4 + d^2.
local low, high = 0, 10
for _ = 1, 60 do
    local d = (low + high) / 2
    local s = math.sqrt(4 + d * d)
    if 2 * k * (s - rest) * d / s < m * 9.81 then low = d else high = d end
end
expect { "it rests where the springs bear it", from = 11, body = "hung", x = 0, y = 3 - low, tolerance = 0.01 }
expect { "it has come to rest", from = 11, body = "hung", max_speed = 0.01 }
expect { "it falls freely while both are slack", at = 0.4, body = "hung", y = 2.5 - 4.905 * 0.16, tolerance = 0.001 }
