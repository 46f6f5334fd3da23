-- top_down_friction.lua - seen from above: pucks slide on a table by friction joints of a known force and torque. They stop
-- after m v^2 / (2 F) and I w^2 / (2 T); one that is pushed by less than F does not move.
scene { title = "Friction from above", gravity = {0, 0}, duration = 6 }
camera { fit = {{-8, -5}, {10, 5}}, at = 1.5, trail = 1.5 }
local m, v, F, I, w, T = 2, 6, 6, 0.5, 8, 1
for i = 1, 3 do
    local y = 2.5 * (i - 2)
    local puck = body { name = "puck" .. i, i == 2 and box { 1, 1 } or circle { 0.5 }, at = {-6, y}, mass = m, inertia = I, color = i,
                        velocity = i < 3 and {v, 0} or nil, spin = i == 2 and w or 0 }
    friction { puck, max_force = F, max_torque = T }
    if i == 3 then every_step(function() puck:apply_force(0.98 * F, 0) end) end
end
local way = m * v * v / (2 * F)
expect { "the first stops after m v^2 / (2 F)", body = "puck1", x = -6 + way, y = -2.5, tolerance = 0.01 * way }
expect { "so does the one that spins", body = "puck2", x = -6 + way, y = 0, tolerance = 0.01 * way }
local turn = math.fmod(I * w * w / (2 * T), 2 * math.pi)
expect { "it has turned by I w^2 / (2 T)", test = function()
    local off = math.abs(math.sin((find("puck2"):angle() - turn) / 2)) return off < 0.05, off, 0.05
end }
expect { "they lie still", from = m * v / F + 0.1, body = "puck*", max_speed = 0.01 }
expect { "pushed by less than F none moves", always = true, body = "puck3", x = -6, tolerance = 1e-3 }
