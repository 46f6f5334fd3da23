-- slow_motion.lua - balls fly through a zone in which time goes at a quarter of its speed.
-- Shows: time_scale. A ball goes through the same parabola, slower while it is inside.
scene { title = "Slow motion", description = "Both balls fly along the same curve; one takes its time.", duration = 4 }
camera { fit = {{-1, -1}, {17, 7}}, at = 3.2, trail = 4 }
local slow = param("slow", 0.25, 0.01, 1)
local left, right = 5, 10 -- of the zone

local free = body { name = "free", circle { 0.2 }, velocity = {8, 10}, color = 1 }
local slowed = body { name = "slowed", circle { 0.2 }, at = {0, 1}, velocity = {8, 10}, color = 2 }
text("slowed to " .. slow .. " from x = " .. left .. " m to " .. right .. " m")

every_step(function()
    local x = slowed:position()
    slowed:set_time_scale(x >= left and x < right and slow or 1)
    local _, y = free:position()
    if y < -0.5 then free:set_type("static") end
    if select(2, slowed:position()) < 0.5 then slowed:set_type("static") end
end)

-- y = 1 + 10 t - g t^2 / 2 with t = x / 8, wherever it is and whatever the time there.
expect { "the slow one keeps to the curve", always = true, test = function()
    local x, y = slowed:position()
    local off = math.abs(y - (1 + 10 * x / 8 - 9.81 / 2 * (x / 8) * (x / 8)))
    return off < 1e-4, off, 1e-4
end }
expect { "the free one is down first", at = 2.2, body = "free", y = {-1, -0.5}, max_speed = 0 }
expect { "the slow one is in the zone still", at = 2.2, body = "slowed", x = {5, 10} }
expect { "and lands beside it, later", at = 4, body = "slowed", y = {0, 0.5}, x = {16.5, 17.2} }
