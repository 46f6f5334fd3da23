-- card_pair.lua - two cards of 2 mm lean on one another at 15 to 30 degrees: the least of a card house.
-- By statics they stand while tan(angle from upright) < 2 mu: at mu = 0.7 all do. Fails: contacts that give, by sliding
-- a little each step. Right: a minute later they stand as they stood.
-- lint: allow size: cards are thin
scene { title = "Pairs of cards", duration = 20, sleep = false }
local paper = material { density = 1000, friction = param("friction", 0.7, 0, 1) }
body { type = "static", box { 40, 1 }, at = {0, -0.5}, material = paper }
for k = 1, 4 do
    local angle = radians(10 + 5 * k)
    local x, y = 0.2 * math.sin(angle), 0.2 * math.cos(angle)
    for side = -1, 1, 2 do
        body { name = ("card%d_%d"):format(k, side), box { 0.002, 0.4 }, material = paper, angle = side * angle,
               at = {k + side * (x + 0.001 * math.cos(angle)), y + 0.001 * math.sin(angle)} }
    end
    expect { ("the pair at %d degrees stands"):format(10 + 5 * k), body = ("card%d_*"):format(k), y = {y - 0.01, y + 0.01} }
end
