-- tunnel_bullets.lua - discs of 5 cm at 10 to 2000 m/s against walls of 1 mm and 10 cm.
-- Fails: matter-js #5 and Chipmunk #212 (no continuous collision), Godot #6664. Right: not one is behind its wall.
-- lint: allow fast-and-thin: fast things are what it asks
scene { title = "Bullets and walls", gravity = {0, 0}, duration = 1 }
for k, thick in ipairs { 0.001, 0.01, 0.1 } do
    body { name = "wall" .. k, type = "static", box { thick, 14 }, at = {k * 100 + thick / 2, 7} }
    for i, v in ipairs { 10, 30, 100, 300, 1000, 2000 } do
        for j = 0, 3 do -- each a part of a step's way further off
            body { name = ("shot%d_%d_%d"):format(k, i, j), circle { 0.05 }, velocity = {v, 0},
                   at = {k * 100 - 2 - j * v / 240, i * 2 + j * 0.3} }
        end
    end
    expect { ("none is behind %g mm"):format(thick * 1000), always = true, body = ("shot%d_*"):format(k), x = {-1e5, k * 100} }
end
