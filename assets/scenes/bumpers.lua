-- bumpers.lua - bumpers give a ball more than it brought, until it is as fast as they are allowed to make it.
-- Shows: restitution above 1 and the cap that ends it; the rest of a pinball table is `pinball.lua`.
-- lint: allow energy-gain: bumpers are meant to
scene { title = "Bumpers", gravity = {0, 0}, duration = 16, seed = 11, restitution_cap = 9,
        description = "Three balls among bumpers of restitution 1.5: faster and faster, up to 9 m/s along a normal." }
camera { fit = {{-6.4, -3.7}, {6.4, 3.7}}, at = 6, trail = 0.5 }
local wall = material { friction = 0, restitution = 1 }
local rubber = material { friction = 0, restitution = 1.5 }
body { name = "frame", type = "static", material = wall, color = "#4a5568",
       box { 13, 0.4, at = {0, 3.6} }, box { 13, 0.4, at = {0, -3.6} }, box { 0.4, 7.6, at = {6.3, 0} }, box { 0.4, 7.6, at = {-6.3, 0} } }
for i, p in ipairs { {-4, 1.6}, {-4, -1.6}, {-0.6, 0}, {2.8, 1.6}, {2.8, -1.6}, {-2.4, 0}, {1.2, 0} } do
    body { name = "bumper" .. i, type = "static", circle { 0.55 }, at = p, material = rubber, color = i % 2 == 1 and "#e9ca6b" or "#e07a5f" }
end
-- Up and down a lane of its own: 2 m/s times 1.5 at each bounce, the cap from the fourth on.
body { name = "rail", type = "static", box { 0.2, 7 }, at = {4.95, 0}, material = wall, color = "#4a5568" }
body { name = "lane", type = "static", material = rubber, box { 0.9, 0.3, at = {5.5, 3.2} }, box { 0.9, 0.3, at = {5.5, -3.2} }, color = "#e07a5f" }
local probe = body { name = "probe", circle { 0.2 }, at = {5.5, 0}, velocity = {0, 2}, material = wall, color = "#2d3436" }
-- They strike one another, too: what two have, one may get.
local balls = {}
for i = 1, 3 do
    balls[i] = body { name = "ball" .. i, circle { 0.2 }, at = {-5.6 + 1.6 * i, -2.7}, velocity = {2, 1 - i}, material = wall, color = i }
end
local bounces, before, off = 0, 2, 0
every_step(function()
    local _, v = probe:velocity()
    if v * before < 0 then bounces = bounces + 1 end
    before = v
    off = math.max(off, math.abs(math.abs(v) - math.min(2 * math.pow(1.5, bounces), 9)))
end)
expect { "a bounce gives half more, until the cap", at = 16, test = function() return bounces > 15 and off < 1e-4, off, 1e-4 end }
expect { "balls are faster than they began", at = 16, test = function()
    local sum = 0
    for _, b in ipairs(balls) do local vx, vy = b:velocity() sum = sum + math.sqrt(vx * vx + vy * vy) / 3 end
    return sum > 6, sum, 6
end }
expect { "they do not run away", always = true, test = function()
    local sum = 0
    for _, b in ipairs(balls) do local vx, vy = b:velocity() sum = sum + (vx * vx + vy * vy) / 3 end
    return math.sqrt(sum) < 9 * 2.5, math.sqrt(sum), 9 * 2.5
end }
