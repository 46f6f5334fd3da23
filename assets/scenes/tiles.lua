-- tiles.lua - a box, a capsule and a disc slide at 20 m/s over 200 tiles, each a body of its own.
-- Shows: ground of many pieces is one ground. Without friction the speed is kept and nothing is lifted; the
-- wall at the end, of tiles too, does stop what comes.
scene { title = "Tiles", duration = 6, description = "Bodies slide over a row of tiles and do not catch on its seams." }
camera { fit = {{28, -3}, {46, 4}}, at = 1.5, trail = 0.25 }

local ice = material { name = "ice", friction = 0 }
for i = 0, 199 do
    body { name = "tile" .. i, type = "static", box { 0.5, 0.5, at = {0, -0.25} }, at = {0.5 * i, 0}, material = ice,
           color = i % 2 == 0 and "#4a5568" or "#5a6578" }
end
for i = 0, 9 do
    body { name = "wall" .. i, type = "static", box { 0.5, 0.5 }, at = {100, 0.25 + 0.5 * i}, material = ice, color = "#4a5568" }
end

body { name = "box", box { 1, 1 }, at = {12, 0.5}, velocity = {20, 0}, material = ice, color = 1 }
body { name = "capsule", capsule { 0.6, 0.25 }, at = {8, 0.25}, velocity = {20, 0}, material = ice, color = 2 }
body { name = "disc", circle { 0.5 }, at = {4, 0.5}, velocity = {20, 0}, material = ice, color = 3 }

for _, name in ipairs { "box", "capsule", "disc" } do
    expect { name .. " keeps its speed", at = 4.2, body = name, vx = {19.9999, 20.0001}, vy = {-1e-4, 1e-4} }
end
expect { "the wall stops the box", at = 6, body = "box", x = {95, 99.26}, y = {0.49, 3} }
