-- pong_curve.lua - pong as it never is: a wind that blows upwards, and a ball that paddles set spinning and that flies in
-- curves for it (the Magnus force of the air). Paddles follow the ball as in pong.lua.
scene { title = "Curve ball", gravity = {0, 0}, duration = 60, seed = 7, description = "Pong with a wind and a ball that curves." }
local width, height = 16, 9
local lively = material { name = "lively", friction = 0, restitution = 1 }
local grip = material { name = "grip", friction = 0.6, restitution = 1 }
local function wall(name, x, y, w, h)
    body { name = name, type = "static", box { w, h }, at = {x, y}, material = lively, color = "#4a5568" }
end
wall("wall_top", 0, height / 2 + 0.25, width + 1, 0.5)
wall("wall_bottom", 0, -height / 2 - 0.25, width + 1, 0.5)
wall("wall_left", -width / 2 - 0.25, 0, 0.5, height)
wall("wall_right", width / 2 + 0.25, 0, 0.5, height)
local air = wind { name = "air", box { width + 1, height + 1 }, flow = {0, 3}, drag = 0.02, magnus = 1.5 }
local function paddle(name, x, color)
    return body { name = name, type = "kinematic", box { 0.3, 1.8 }, at = {x, 0}, material = grip, color = color }
end
local left, right = paddle("paddle_left", -7, "#2b6cb0"), paddle("paddle_right", 7, "#c05621")
local ball = body { name = "ball", circle { 0.25 }, at = {0, 0.3}, velocity = {9, 3}, material = grip, color = "#d69e2e" }
local function follow(pad, coming)
    local _, y = pad:position()
    local _, target = ball:position()
    local reach = height / 2 - 1
    if not coming then target = 0 end
    target = math.max(-reach, math.min(reach, target))
    pad:set_velocity(0, math.max(-7, math.min(7, (target - y) * 8)))
end
score("returns", 0)
local bent, spun = 0, 0
every_step(function()
    local vx, vy = ball:velocity()
    follow(left, vx < 0)
    follow(right, vx > 0)
    local v = math.sqrt(vx * vx + vy * vy)
    if v > 1 then ball:set_velocity(vx * 9.5 / v, vy * 9.5 / v) end   -- it never tires
    spun = math.max(spun, math.abs(ball:spin()))
end)
local before
every(0.25, function()
    local vx, vy = ball:velocity()
    local heading = math.atan(vy, vx)
    if before and math.abs(heading - before) < 1 then bent = math.max(bent, math.abs(heading - before)) end
    before = heading
end)
on_contact { a = "ball", b = "paddle*", function() score("returns", score("returns") + 1) end }
camera { fit = {{-8.6, -5.1}, {8.6, 5.1}}, at = 7, trail = 1.6 }
expect { "it is returned", at = 60, test = function() return score("returns") >= 10, score("returns"), 10 end }
expect { "it spins", at = 60, test = function() return spun > 5, spun, 5 end }
expect { "it flies in curves", at = 60, test = function() return bent > 0.05, bent, 0.05 end }
expect { "it stays in the field", at = 60, body = "ball", x = {-8, 8}, y = {-4.5, 4.5} }
