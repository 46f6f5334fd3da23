-- restitution_threshold.lua - balls with e = 0.8 fall from 5, 20 and 80 cm in a world where approaches below 3 m/s do not
-- bounce. 80 cm is 3.96 m/s: it bounces once, to e^2 h = 51 cm, comes back at 3.17, bounces to 33 cm, and then lies.
-- 20 cm is 1.98 m/s: it stays down.
scene { title = "Restitution threshold", restitution_speed = 3, duration = 4 }
camera { fit = {{-2, -0.4}, {4, 1.6}}, at = 0.6, trail = 0.6 }
body { type = "static", box { 20, 1 }, at = {1, -0.5} }
local rubber = material { restitution = 0.8 }
local top = { 0, 0, 0 }
for k, h in ipairs { 0.05, 0.2, 0.8 } do
    body { name = "ball" .. k, circle { 0.1 }, at = {k - 1, h + 0.1}, material = rubber, color = k }
end
local hit, apex = {}, { 0, 0, 0 }
on_contact { a = "ball*", function(ball) local k = tonumber(ball:name():sub(5)) hit[k] = (hit[k] or 0) + 1 end }
every_step(function()
    for k = 1, 3 do
        local _, y = find("ball" .. k):position()
        if hit[k] then apex[k] = math.max(apex[k], y - 0.1) end
    end
end)
expect { "from 80 cm it bounces to e^2 h", test = function() local off = math.abs(apex[3] - 0.64 * 0.8) return off < 0.01, apex[3], 0.512 end }
expect { "and twice, not more", test = function() return hit[3] == 3, hit[3], 3 end }
for k = 1, 2 do
    expect { ("ball %d stays down"):format(k), test = function() return apex[k] < 0.005, apex[k], 0.005 end }
end
expect { "all lie", body = "ball*", y = 0.1, speed = {0, 0.01}, tolerance = 0.002 }
