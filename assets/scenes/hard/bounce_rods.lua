-- bounce_rods.lua - Bounce House of Box2D: a rod of 4 m at e = 1 in a closed box without friction and gravity; beside it
-- ten balls. Fails: all engines that SimBenchmark looked at gain or lose energy; Rapier #97, Jolt #1286.
-- Right: energy stays: judged by places and turns, within 1 %.
scene { title = "Bounce house", gravity = {0, 0}, duration = 30, seed = 8 }
local steel = material { density = 1000, friction = 0, restitution = 1 }
for k = 0, 1 do
    body { type = "static", material = steel, box { 22, 1, at = {k * 30, -10.5} }, box { 22, 1, at = {k * 30, 10.5} },
           box { 1, 20, at = {k * 30 - 10.5, 0} }, box { 1, 20, at = {k * 30 + 10.5, 0} } }
end
local things = { body { name = "rod", box { 4, 0.2 }, at = {0, 0}, velocity = {10, 20}, material = steel } }
for i = 1, 10 do
    things[i + 1] = body { name = "ball" .. i, circle { 0.5 }, at = {30 + (i % 5 - 2) * 3, i > 5 and 3 or -3}, material = steel,
                           velocity = {random(-8, 8), random(-8, 8)} }
end
-- Kinetic energy by how far each moves and turns within a step. A step in which something bounces shows less, one that
-- pushes an overlap out more: of a second's steps the one counts above which a fifth of them are.
local was, seen, first, now = {}, { {}, {} }, {}, {}
every_step(function()
    local energy = { 0, 0 }
    for i, b in ipairs(things) do
        local x, y = b:position()
        local angle, k = b:angle(), i == 1 and 1 or 2
        if was[i] then
            local dx, dy, turn = x - was[i][1], y - was[i][2], angle - was[i][3]
            turn = turn - 2 * math.pi * math.floor(turn / (2 * math.pi) + 0.5)
            energy[k] = energy[k] + (b:mass() * (dx * dx + dy * dy) + b:inertia() * turn * turn) * 1800
        end
        was[i] = {x, y, angle}
    end
    for k = 1, 2 do table.insert(seen[k], energy[k]) end
end)
every(1, function()
    for k = 1, 2 do
        table.sort(seen[k])
        now[k] = seen[k][#seen[k] * 4 // 5]
        first[k], seen[k] = first[k] or now[k], {}
    end
end)
for k, what in ipairs { "the rod", "the balls" } do
    expect { "energy stays: " .. what, from = 1.1, test = function()
        return math.abs(now[k] / first[k] - 1) <= 0.01, now[k] / first[k], 1
    end }
end
expect { "nobody leaves", always = true, body = "rod", x = {-10, 10}, y = {-10, 10} }
expect { "no ball leaves", always = true, body = "ball*", x = {20, 40}, y = {-10, 10} }
