-- chain_1e3.lua - a chain of 50 links of 0.2 m and 1 kg hangs straight with a weight of 1,000 kg at its end: the end stays
-- 10 m below, the first hinge bears all.
-- Source: statics. Hard: sweeps along a chain gain a digit in about 2.3 N R sweeps, here 115,000.
-- Aim: 1e-3 m, 1e-3 of the force.
-- lint: allow mass-ratio: that is what it asks about
scene { title = "Chain with 1,000 : 1", duration = 3, description = "A weight of 1,000 kg on a chain of 50 light links." }
local g, n, l, ratio = 9.81, 50, 0.2, 1e3
local last, top = world, nil
for i = 1, n do
    local link = body { name = "link" .. i, box { 0.05, l }, at = {0, -(i - 0.5) * l}, mass = 1, apart = "chain", sleep = false }
    local hinge = revolute { last, link, at = {0, -(i - 1) * l} }
    top, last = top or hinge, link
end
local weight = body { name = "weight", box { 1, 1 }, at = {0, -n * l - 0.5}, mass = ratio, apart = "chain", sleep = false,
        color = 2 }
revolute { last, weight, at = {0, -n * l} }
exact { "end", body = "weight", x = function() return 0 end, y = function() return -n * l - 0.5 end }
exact { "force", scale = (ratio + n) * g, from = 2, measure = function() return top:reaction() end,
        value = function() return (ratio + n) * g end }
expect { "the end stays", exact = "end", tolerance = 11 }
expect { "the first hinge's force", exact = "force", tolerance = 1.4 }
