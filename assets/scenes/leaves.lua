-- leaves.lua - leaves on a pond go round in two eddies whose border swings to and fro: formula{} of place, time and velocity. The water is
-- the double gyre of Shadden, Lekien and Marsden (2005), whose flow is known everywhere; drag of a rate of 12 / s takes the leaves along. Who
-- crosses from one eddy into the other is a matter of a moment.
scene { title = "Leaves", gravity = {0, 0}, duration = 30, seed = 5,
        description = "Leaves in two eddies that swing: a field as a formula of place, time and velocity." }
local swing = "(0.25 * sin(0.6 * t))" -- how far the border is off the middle
local f = swing .. " * (x / 6)^2 + (1 - 2 * " .. swing .. ") * x / 6"
local slope = "(" .. swing .. " * x / 3 + 1 - 2 * " .. swing .. ")"
formula { at = {-6, -3}, x = "12 * (-1.5 * sin(pi * (" .. f .. ")) * cos(pi * y / 6) - vx)",
          y = "12 * (1.5 * cos(pi * (" .. f .. ")) * sin(pi * y / 6) * " .. slope .. " - vy)" }
local stone = material { friction = 0.1 }
for i = -1, 1, 2 do
    body { name = "bank" .. i, type = "static", box { 12.6, 0.3 }, at = {0, 3.15 * i}, material = stone, color = "#6b5d4a" }
    body { name = "end" .. i, type = "static", box { 0.3, 6 }, at = {6.15 * i, 0}, material = stone, color = "#6b5d4a" }
end
local colors = { "#d9822b", "#c2452d", "#e8b23a", "#8a9a3b", "#a65e2e" }
for i = 1, 150 do
    local size = random(0.10, 0.16)
    body { name = "leaf" .. i, polygon { {-1.6 * size, 0}, {-0.6 * size, -0.6 * size}, {0.5 * size, -0.6 * size}, {1.7 * size, 0},
                                         {0.5 * size, 0.6 * size}, {-0.6 * size, 0.6 * size} },
           at = {-5.5 + 0.5 * ((i - 1) % 23), -2.5 + 0.8 * ((i - 1) // 23)}, angle = random(0, 6.28), density = 0.3, material = stone,
           color = colors[random_int(1, 5)] }
end
camera { fit = {{-6.6, -3.6}, {6.6, 3.6}}, at = 12, trail = 0.6 }
expect { "they stay in the pond", body = "leaf*", x = {-6, 6} }
expect { "and are no faster than the water", body = "leaf*", from = 2, max_speed = 2.6 }
expect { "which takes them along", from = 2, test = function() -- the mean of what they lack of its velocity at their places
    local sum, a = 0, 0.25 * math.sin(0.6 * time())
    for i = 1, 150 do
        local leaf = find("leaf" .. i)
        local x, y = leaf:position()
        local vx, vy = leaf:velocity()
        x, y = (x + 6) / 6, math.pi * (y + 3) / 6
        local g = math.pi * (a * x * x + (1 - 2 * a) * x)
        local u, v = -1.5 * math.sin(g) * math.cos(y), 1.5 * math.cos(g) * math.sin(y) * (2 * a * x + 1 - 2 * a)
        sum = sum + math.sqrt((u - vx) ^ 2 + (v - vy) ^ 2)
    end
    return sum / 150 < 0.2, sum / 150, 0.2
end }
