-- bounce_house.lua - a disc, a box and a long capsule fly about in a square of four walls at 10 m/s, without gravity,
-- friction or loss. None leaves, and none gains or loses energy; those that begin without spin may turn.
scene { title = "Bounce house", gravity = {0, 0}, duration = 20 }
camera { fit = {{-11, -6}, {11, 6}}, at = 3, trail = 1.5 }
local rubber = material { friction = 0, restitution = 1 }
body { type = "static", material = rubber, chain { {-10, -5}, {10, -5}, {10, 5}, {-10, 5}, closed = true } }
body { name = "disc", circle { 0.5 }, at = {0, 0}, velocity = {8, 6}, material = rubber, color = 1 }
body { name = "box", box { 0.9, 0.5 }, at = {-5, 2}, velocity = {-6, 8}, material = rubber, color = 2, apart = "guests" }
body { name = "capsule", capsule { 1.2, 0.2 }, at = {5, -2}, velocity = {10, 0}, spin = 3, material = rubber, color = 3, apart = "guests" }
for _, name in ipairs { "disc", "box", "capsule" } do
    expect { ("the %s stays inside"):format(name), always = true, body = name, x = {-10, 10}, y = {-5, 5} }
end
expect { "no energy is gained or lost", always = true, energy_drift = 0.01 }
