-- pong_gravity.lua - pong under a gravity that turns once in eight seconds: the ball falls to another wall each time.
-- Shows: set_gravity from a handler, in each step; what is elastic keeps its energy but for the work of what turns, which is known.
scene { title = "Pong with gravity that turns", gravity = {0, -3}, duration = 60, seed = 7,
        description = "Gravity turns like the hand of a clock; the ball falls to another wall each time." }
camera { fit = {{-8.6, -5.1}, {8.6, 5.1}}, at = 9.6, trail = 1.6 }
local width, height, pull, turn = 16, 9, 3, 2 * math.pi / 8
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
local left, right = paddle("paddle_left", -7, "#2b6cb0"), paddle("paddle_right", 7, "#c05621")
local ball = body { name = "ball", circle { 0.25 }, at = {0, 0.3}, velocity = {6, 2}, material = lively, color = "#d69e2e" }
-- The hand of the clock, for the eye.
local hand = body { type = "kinematic", sensor = true, polygon { {-0.12, 0}, {0.12, 0}, {0, -1.6} }, at = {0, 0}, color = "#2d3748" }

local function follow(pad)
    local _, y = pad:position()
    local _, target = ball:position()
    local reach = height / 2 - 1
    pad:set_velocity(0, math.max(-9, math.min(9, (math.max(-reach, math.min(reach, target)) - y) * 8)))
end
score("returns", 0)
-- Gravity that turns by an angle a does the work m (g' - g) . x on what is at x; paddles that do not move across the ball's way do none.
local m, worked, first = ball:mass(), 0, nil
local gx, gy = 0, -pull
local function kinetic() local v = ball:speed() return m * v * v / 2 end
every_step(function(t)
    local x, y = ball:position()
    local nx, ny = pull * math.sin(turn * t), -pull * math.cos(turn * t)
    first = first or kinetic() - m * (gx * x + gy * y)
    worked = worked - m * ((nx - gx) * x + (ny - gy) * y)
    gx, gy = nx, ny
    set_gravity(gx, gy)
    hand:move_to(0, 0, turn * t)
    follow(left)
    follow(right)
end)
on_contact { a = "ball", b = "paddle*", function() score("returns", score("returns") + 1) end }
local seen = {}
on_contact { a = "ball", b = "wall*", function(_, side) seen[side:name()] = true end }

expect { "it is returned", at = 60, test = function() return score("returns") >= 10, score("returns"), 10 end }
expect { "it has fallen down, and up", at = 60, test = function() return seen.wall_bottom and seen.wall_top end }
expect { "it stays in the field", always = true, body = "ball", x = {-7.76, 7.76}, y = {-4.26, 4.26} }
local function drift()
    local x, y = ball:position()
    return math.abs(kinetic() - m * (gx * x + gy * y) - first - worked) / first
end
-- Later a paddle's end pinches it against a wall, and works on it.
expect { "its energy is what gravity's turning gave it", from = 0, till = 40, test = function() local d = drift() return d < 1e-6, d, 1e-6 end }
