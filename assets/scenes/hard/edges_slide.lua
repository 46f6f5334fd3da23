-- edges_slide.lua - boxes, discs and capsules slide and roll 40 m over tiles of 1 m, of 10 cm, and over a chain.
-- Fails: ghost collisions at seams (Rapier #669, Jolt #1155, Box2D: Ghost Bumps). Right: seams do not exist: nothing
-- hops by a millimetre, and nobody is slowed by them.
scene { title = "Ghost edges", duration = 2 }
local v = param("speed", 15, 0.1, 200)
local ice = material { friction = 0 }
local points = {}
for i = 0, 100 do points[i + 1] = {50 - i, 20} end
local tiles = { type = "static", material = ice, chain(points) }
for i = 0, 49 do tiles[#tiles + 1] = box { 1, 1, at = {i + 0.5, -0.5} } end
for i = 0, 499 do tiles[#tiles + 1] = box { 0.1, 1, at = {i * 0.1 + 0.05, 9.5} } end
body(tiles)
local shapes = { box = box { 0.6, 0.6 }, disc = circle { 0.3 }, capsule = capsule { 0.5, 0.3 } }
local ground = { [0] = "tiles of 1 m", [10] = "tiles of 10 cm", [20] = "a chain" }
for k, y in ipairs { 0, 10, 20 } do
    local count = 0
    for name, shape in pairs(shapes) do
        count = count + 1
        body { name = ("slider%d_%s"):format(k, name), shape, at = {2 * count, y + 0.3}, velocity = {v, 0}, material = ice }
        expect { ("the %s on %s is not slowed"):format(name, ground[y]), body = ("slider%d_%s"):format(k, name),
                 x = 2 * count + 2 * v, tolerance = 0.01 }
    end
    expect { "nothing hops on " .. ground[y], always = true, body = ("slider%d_*"):format(k), y = {y + 0.295, y + 0.301} }
    expect { "nothing turns on " .. ground[y], body = ("slider%d_*"):format(k), angle = {-1e-3, 1e-3} }
end
