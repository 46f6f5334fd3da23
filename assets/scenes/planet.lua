-- planet.lua - a small round world: boxes are piled all round it by its own pull, a moon goes round, and a comet comes by. The
-- planet is a static body that carries attractor{}; what rests on it falls asleep.
scene { title = "A small planet", gravity = {0, 0}, duration = 20,
        description = "Piles all round a planet, a moon, a comet." }
local ground = material { friction = 0.7 }
body { name = "planet", type = "static", circle { 5 }, material = ground, color = "#5b7f4e" }
attractor { body = "planet", strength = 250 }
orbits { order = 4 }
for i = 0, 7 do
    local a = i * math.pi / 4
    local c, s = math.cos(a), math.sin(a)
    for k = 0, 3 do
        body { name = "box" .. i .. k, box { 0.6, 0.6 }, at = {(5.3 + 0.61 * k) * c, (5.3 + 0.61 * k) * s}, angle = a,
               material = ground, color = 1 + (i + k) % 6 }
    end
end
body { name = "moon", circle { 0.5 }, at = {12, 0}, velocity = {0, math.sqrt(250 / 12)}, color = "#c9c9d6" }
body { name = "comet", circle { 0.25 }, at = {-17, 9}, velocity = {4.5, 1.5}, color = "#f2b84b" }
camera { fit = {{-17, -11}, {17, 11}}, at = 6, trail = 2 }
expect { "the piles stand", body = "box03", max_speed = 0.5 }
expect { "the moon stays on its circle", body = "moon", min_speed = 4.55, max_speed = 4.58 }
