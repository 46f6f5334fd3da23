-- card_house.lua - Card House of Solver2D: five storeys of cards 2 mm thin and 40 cm long.
-- Fails: most solvers; Plumb at 2 to 5 substeps and at 48 and 64. Box2D stands by reusing contacts that have turned.
-- Right: it stands.
-- lint: allow overlap, size: cards are thin, and lean on one another
scene { title = "Card House", duration = 20 }
local storeys, friction = param("storeys", 5, 1, 8), param("friction", 0.7, 0, 1)
local paper = material { density = 1000, friction = friction }
body { type = "static", box { 80, 4 }, at = {0, -2}, material = paper }
local height, thick, count = 0.2, 0.001, 0 -- halves
local function card(x, y, angle)
    count = count + 1
    body { name = "card" .. count, box { 2 * thick, 2 * height }, at = {x, y}, angle = angle, material = paper }
end
local leaning, flat = radians(25), radians(90)
local x0, y, n = 0, height - 0.02, storeys
while n > 0 do
    local x = x0
    for i = 1, n do
        if i ~= n then card(x + 0.25, y + height - 0.015, flat) end
        card(x, y, -leaning)
        x = x + 0.175
        card(x, y, leaning)
        x = x + 0.175
    end
    y, x0, n = y + height * 2 - 0.03, x0 + 0.175, n - 1
end
expect { "the top storey stands", always = true, body = "card" .. count, y = {y - 2 * height - 0.03, y} }
