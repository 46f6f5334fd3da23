-- pong.lua - two paddles follow the ball; walls and paddles return it without loss (e = 1, no friction).
-- Shows: bounces at any angle and speed that never stick, slide along a wall or lose energy, and a
-- score kept by a handler: each return counts; a ball that gets past a paddle is a miss.
scene {
    title = "Pong",
    description = "Two paddles follow the ball; 10,000 bounces without a loss of energy.",
    gravity = {0, 0},
    duration = 9000,
    seed = 7,
}
camera { fit = {{-8.6, -5.1}, {8.6, 5.1}} }

local width, height = 16, 9
local lively = material { name = "lively", friction = 0, restitution = 1 }

local function wall(name, x, y, w, h)
    body { name = name, type = "static", box { w, h }, at = {x, y}, material = lively, color = "#4a5568" }
end
wall("wall_top", 0, height / 2 + 0.25, width + 1, 0.5)
wall("wall_bottom", 0, -height / 2 - 0.25, width + 1, 0.5)
wall("wall_left", -width / 2 - 0.25, 0, 0.5, height)
wall("wall_right", width / 2 + 0.25, 0, 0.5, height)

local function paddle(name, x, color)
    return body { name = name, type = "kinematic", box { 0.3, 1.8 }, at = {x, 0}, material = lively, color = color }
end
local left = paddle("paddle_left", -7, "#2b6cb0")
local right = paddle("paddle_right", 7, "#c05621")
local ball = body {
    name = "ball", circle { 0.2 }, at = {0, 0.3}, velocity = {9.3, 4.1}, material = lively,
    fixed_rotation = true, color = "#d69e2e",
}

score("left", 0)
score("right", 0)
score("missed", 0)
score("bounces", 0)

-- A paddle moves towards the height of the ball, at most at 7 m/s, when the ball comes its way.
local function follow(pad, coming)
    local _, y = pad:position()
    local _, target = ball:position()
    local reach = height / 2 - 1.0
    if not coming then target = 0 end
    target = math.max(-reach, math.min(reach, target))
    pad:set_velocity(0, math.max(-7, math.min(7, (target - y) * 8)))
end
every_step(function()
    local vx = ball:velocity()
    follow(left, vx < 0)
    follow(right, vx > 0)
end)

on_contact { a = "ball", function(_, other)
    score("bounces", score("bounces") + 1)
    local name = other:name()
    if name == "paddle_left" then score("left", score("left") + 1) end
    if name == "paddle_right" then score("right", score("right") + 1) end
    if name == "wall_left" or name == "wall_right" then score("missed", score("missed") + 1) end
end }

expect { "10,000 bounces", score = "bounces", value = {10000, 1e6} }
expect { "the ball keeps its energy", always = true, energy_drift = 1e-3 }
expect { "the ball stays on the table", always = true, body = "ball", x = {-8, 8}, y = {-4.5, 4.5} }
expect { "no ball is missed", score = "missed", value = 0 }
expect { "the ball never slides along a wall", always = true, test = function()
    local vx, vy = ball:velocity()
    local slowest = math.min(math.abs(vx) / 9.3, math.abs(vy) / 4.1)
    return slowest > 0.99, slowest, 0.99
end }
