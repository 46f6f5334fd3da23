-- egg_box.lua - marbles roll over the hills of an egg box and come to rest in its hollows: a potential as formula{}, whose slope is the
-- force, and a brake that is another. The hollows lie where sin(pi x / 2) sin(pi y / 2) is -1. Seen from above.
scene { title = "Egg box", gravity = {0, 0}, duration = 20, seed = 3,
        description = "Marbles come to rest in the hollows of a potential that is a formula." }
formula { potential = "4 * sin(pi * x / 2) * sin(pi * y / 2) + 0.03 * r^2" }
formula { x = "-0.8 * vx", y = "-0.8 * vy" }
local glass = material { friction = 0.1, restitution = 0.6, density = 2 }
for i = -5, 4 do -- a ring where each hill is highest, to see where they are
    for k = -4, 3 do
        if (i + k) % 2 == 0 then
            body { name = "hill" .. i .. "_" .. k, type = "static", sensor = true, circle { 0.3 }, at = {2 * i + 1, 2 * k + 1},
                   color = "#b08a4a" }
        end
    end
end
for i = 1, 70 do
    local a, r = 2.4 * i, 0.42 * math.sqrt(i)
    body { name = "marble" .. i, circle { random(0.17, 0.24) }, material = glass, at = {r * math.cos(a), r * math.sin(a)},
           velocity = {5 * math.cos(a + 0.4), 5 * math.sin(a + 0.4)}, color = i % 6 }
end
camera { fit = {{-8.5, -4.8}, {8.5, 4.8}}, at = 2.5, trail = 1 }
expect { "all come to rest", body = "marble*", max_speed = 0.05 }
expect { "in hollows", test = function() -- the highest that one lies, between -1 and 1
    local highest = -1
    for i = 1, 70 do
        local x, y = find("marble" .. i):position()
        highest = math.max(highest, math.sin(math.pi * x / 2) * math.sin(math.pi * y / 2))
    end
    return highest < -0.4, highest, -0.4
end }
