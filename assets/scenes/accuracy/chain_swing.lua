-- chain_swing.lua - a weight of 10,000 kg on a chain of 50 links of 1 kg, let go from the horizontal: the chain stays as
-- long as it is, and the energy too.
-- Source: conservation of energy. Hard: as chain_1e4, with forces that grow to three weights and turn.
-- Aim: 1e-2 m, 1e-3 of the energy.
-- lint: allow mass-ratio: that is what it asks about
-- watchdog: allow torn-joint: what gives way is what it measures
scene { title = "Heavy swing", duration = 3, description = "A heavy weight swings on a light chain." }
local g, n, l, ratio = 9.81, 50, 0.2, 1e4
local last = world
for i = 1, n do
    local link = body { name = "link" .. i, box { l, 0.05 }, at = {(i - 0.5) * l, 0}, mass = 1, apart = "chain", sleep = false }
    revolute { last, link, at = {(i - 1) * l, 0} }
    last = link
end
local weight = body { name = "weight", circle { 0.5 }, at = {n * l, 0}, mass = ratio, apart = "chain", sleep = false, color = 2 }
revolute { last, weight, at = {n * l, 0} }
exact { "length", unit = "m", value = function() return n * l end, measure = function()
    local x, y = weight:position()
    return math.sqrt(x * x + y * y)
end }
exact { "energy", scale = ratio * g * n * l, value = function() return 0 end, measure = function()
    local kinetic, potential = energy()
    return kinetic + potential
end }
expect { "the length", exact = "length", tolerance = 47 }
expect { "the energy", exact = "energy", tolerance = 2.1 }
