-- tunnel_on_rope.lua - heavy balls on ropes and rods that swing at 60 m/s into a wall of 1 cm.
-- Fails: continuous collision that does not know of joints: the rope pulls the ball through (Box2D ignores joints there).
-- Right: the ball stays on its side.
-- lint: allow fast-and-thin: fast things are what it asks
scene { title = "Ball on a rope against a wall", duration = 2 }
for k, v in ipairs { 10, 30, 60, 120 } do
    local x = k * 10
    body { type = "static", box { 0.01, 4 }, at = {x + 0.31, -3} }
    local ball = body { name = "ball" .. k, circle { 0.3 }, at = {x - 3, 0}, mass = 100, velocity = {0, -v} }
    distance { world, ball, at_a = {x, 0}, limits = {0, 3} }
    expect { ("%g m/s stays on its side"):format(v), always = true, body = "ball" .. k, x = {-1e3, x + 0.31} }
end
expect { "ropes are whole", always = true, max_joint_error = 0.3 }
