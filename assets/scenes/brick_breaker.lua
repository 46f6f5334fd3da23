-- brick_breaker.lua - a ball clears a wall of bricks; a brick vanishes when it is hit.
-- Shows: bodies destroyed by a contact handler while the ball goes on without losing speed.
scene { title = "Brick breaker", description = "Bricks vanish when the ball hits them.",
        gravity = {0, 0}, duration = 600, seed = 3 }
camera { fit = {{-5.6, -2}, {5.6, 9.2}}, at = 6, trail = 0.5 }

local lively = material { name = "lively", friction = 0, restitution = 1 }
body {
    name = "frame", type = "static", material = lively, color = "#4a5568",
    box { 0.4, 10.8, at = {-5.2, 3.6} }, box { 0.4, 10.8, at = {5.2, 3.6} }, box { 10, 0.4, at = {0, 8.8} },
    box { 10, 0.4, at = {0, -1.6} },
}

local columns, rows = 8, 5
local colors = { "#c53030", "#dd6b20", "#d69e2e", "#38a169", "#3182ce" }
for row = 1, rows do
    for column = 1, columns do
        body {
            name = ("brick_%d_%d"):format(row, column), type = "static", box { 1.1, 0.4 },
            at = {(column - (columns + 1) / 2) * 1.22, 8.2 - row * 0.55}, material = lively, color = colors[row],
        }
    end
end

local paddle = body { name = "paddle", type = "kinematic", capsule { 1.2, 0.15 }, at = {0, 0.5},
                      material = lively, color = "#2d3748" }
local ball = body { name = "ball", circle { 0.18 }, at = {0.7, 1.5}, velocity = {4.3, 7.9}, material = lively,
                    fixed_rotation = true, color = "#2d3748" }

score("bricks", 0)
-- The paddle keeps under the ball; it leads by a varying amount, so that the path does not repeat.
every_step(function(t)
    local x = paddle:position()
    local target = ball:position() + 0.5 * math.sin(1.7 * t)
    target = math.max(-3.7, math.min(3.7, target)) -- leaves room for the ball beside it
    paddle:set_velocity(math.max(-9, math.min(9, (target - x) * 10)), 0)
end)

-- The paddle's ends are round and moving, so it may speed the ball up or slow it down: it is given its
-- speed back, as such games do.
local speed = math.sqrt(4.3^2 + 7.9^2)
on_contact { a = "ball", b = "paddle", function()
    local vx, vy = ball:velocity()
    local factor = speed / ball:speed()
    ball:set_velocity(vx * factor, vy * factor)
end }

on_contact { a = "ball", b = "brick*", function(_, brick)
    brick:destroy()
    score("bricks", score("bricks") + 1)
    if score("bricks") == columns * rows then
        text("all clear")
        finish()
    end
end }

expect { "every brick was hit", score = "bricks", value = columns * rows }
expect { "no brick is left", body = "brick*", count = 0 }
expect { "the ball stays in the frame", always = true, body = "ball", x = {-5, 5}, y = {-1.4, 8.6} }
expect { "the ball keeps its speed", always = true, body = "ball", speed = speed, tolerance = 0.01 * speed }
