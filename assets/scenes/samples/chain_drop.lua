-- chain_drop.lua - a disc, a box and a capsule fall at 42 to 300 m/s onto a thin chain, 5 m a step; so do they when
-- they spin. They stay on it and come to rest on it.
scene { title = "Chain drop", duration = 4 }
camera { fit = {{-9, -1}, {24, 9}}, at = 0.02, trail = 0.1 }
body { name = "floor", type = "static", chain { {-10, 2}, {-8, 0}, {23, 0}, {25, 2} } }
local tough = material { restitution = 0, friction = 0.6, rolling_resistance = 0.1 }
local n = 0
for i, v in ipairs { 42, 100, 300 } do
    for k, spin in ipairs { 0, 40 } do
        local x = 10 * (i - 1) + 4.5 * (k - 1) - 5
        body { name = ("disc%d_%d"):format(i, k), circle { 0.4 }, at = {x, 5}, velocity = {0, -v}, spin = spin, material = tough, apart = "things", color = 1 }
        body { name = ("box%d_%d"):format(i, k), box { 0.7, 0.7 }, at = {x + 1.4, 5}, velocity = {0, -v}, spin = spin, material = tough, apart = "things", color = 2 }
        body { name = ("capsule%d_%d"):format(i, k), capsule { 0.6, 0.2 }, at = {x + 2.8, 5}, velocity = {0, -v}, spin = spin, material = tough, apart = "things", color = 3 }
    end
end
for _, kind in ipairs { "disc", "box", "capsule" } do
    expect { ("no %s falls through"):format(kind), always = true, body = kind .. "*", y = {0, 40} }
    expect { ("every %s rests on it"):format(kind), body = kind .. "*", y = {0.19, 2.3}, max_speed = 1 }
end
expect { "dead ones do not bounce", from = 0.3, till = 1, body = "disc3_1", y = {0.38, 0.45} }
