-- bounce_box.lua - one ball in a box without gravity: 10,000 bounces at e = 1.
-- Shows: speed and angle of incidence are kept exactly; nothing sticks to a wall.
-- The exact motion is free flight folded at the walls, which the second expectation compares.
scene {
    title = "Ten thousand bounces",
    description = "A ball between four walls, e = 1, no friction: speed and path never fade.",
    gravity = {0, 0},
    duration = 2200,
}
camera { fit = {{-5.5, -3.5}, {5.5, 3.5}} }

local lively = material { name = "lively", friction = 0, restitution = 1 }
body {
    name = "box", type = "static", material = lively, color = "#4a5568",
    box { 11, 0.5, at = {0, 3.25} }, box { 11, 0.5, at = {0, -3.25} },
    box { 0.5, 6, at = {5.25, 0} }, box { 0.5, 6, at = {-5.25, 0} },
}
local vx, vy = 23.7, 13.1
body {
    name = "ball", circle { 0.25 }, at = {0.1, -0.2}, velocity = {vx, vy}, material = lively,
    fixed_rotation = true, color = 3,
}

score("bounces", 0)
on_contact { a = "ball", function() score("bounces", score("bounces") + 1) end }

expect { "10,000 bounces", score = "bounces", value = {10000, 20000} }
expect { "no energy is lost", always = true, energy_drift = 1e-3 }
expect { "the ball stays inside", always = true, body = "ball", x = {-4.8, 4.8}, y = {-2.8, 2.8} }
expect { "it never slides along a wall", always = true, test = function()
    local bx, by = find("ball"):velocity()
    local slowest = math.min(math.abs(bx) / vx, math.abs(by) / vy)
    return slowest > 0.99, slowest, 0.99
end }
