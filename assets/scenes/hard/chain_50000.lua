-- chain_50000.lua - the pendulum of the AVBD paper: 50 links, 50,000 times a link's mass at the end.
-- Fails: every iterative solver that is not told of stiffness: 2e10 m measured here, 63 m in Box2D; XPBD gives.
-- Right: a pendulum of constant length.
-- lint: allow mass-ratio: that is what it asks about
scene { title = "AVBD's pendulum, 50,000 : 1", duration = 4 }
local links, ratio = param("links", 50, 2, 200), param("ratio", 50000, 1, 1e6)
local length = links * 0.5
local last = body { type = "static", circle { 0.05 }, at = {0, 0}, apart = "chain" }
for i = 1, links do
    local load = i == links
    local link = body { name = load and "load" or "link" .. i, box { 0.5, 0.1 }, at = {i * 0.5 - 0.25, 0},
                        mass = load and ratio or 1, apart = "chain" }
    revolute { last, link, at = {(i - 1) * 0.5, 0} }
    last = link
end
local highest, farthest = 0, 0
every_step(function()
    local x, y = last:position()
    highest, farthest = math.max(highest, y), math.max(farthest, math.sqrt(x * x + y * y))
end)
expect { "it never rises above its start", test = function()
    return highest <= 0.01 * length, highest / length, 0.01
end }
expect { "it keeps its length within 1 %", test = function()
    return farthest <= 1.01 * length, farthest / length, 1.01
end }
