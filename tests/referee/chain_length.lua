-- chain_length.lua - a chain of `links` that hangs, a hundred times the mass of a link at its end: how much longer it is at
-- any moment than it was made. Right: links do not stretch.
-- lint: allow mass-ratio: the load is what it asks about
scene { title = "Load on a chain", duration = 4, sleep = false }
local links, ratio = param("links", 20, 2, 320), param("ratio", 100, 1, 1e6)
local last, link = body { type = "static", box { 0.2, 0.2 }, at = {0, 0.1} }
for i = 1, links do
    link = body { name = "link" .. i, box { 0.1, 0.4 }, at = {0, 0.2 - i * 0.4}, mass = i == links and ratio or 1, apart = "chain" }
    revolute { last, link, at = {0, 0.4 - i * 0.4} }
    last = link
end
local length, most = links * 0.4 - 0.2, 0
every_step(function()
    local x, y = link:position()
    most = math.max(most, math.sqrt(x * x + y * y) / length - 1)
end)
expect { "it stretches by 1 % at most", test = function() return most <= 0.01, most, 0.01 end }
