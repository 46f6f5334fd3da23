-- beam.lua - an uneven beam hangs on two rods at -1.5 and 1.5 m: they bear m g (1.5 +- x) / 3, x the place of its centre
-- of mass.
-- Source: Archimedes, On the Equilibrium of Planes. Hard: hardly, but forces that are told must be right.
-- Aim: 1e-4 of the weight.
scene { title = "Beam on two rods", duration = 3, description = "What two rods bear of an uneven beam." }
local beam = body { name = "beam", box { 4, 0.2 }, circle { 0.4, at = {1, 0} }, sleep = false }
local g, m, x = 9.81, beam:mass(), beam:center()
local left = distance { world, beam, at_a = {-1.5, 2}, at_b = {-1.5, 0} }
local right = distance { world, beam, at_a = {1.5, 2}, at_b = {1.5, 0} }
for name, rod in pairs { left = left, right = right } do
    local share = name == "left" and (1.5 - x) / 3 or (1.5 + x) / 3
    exact { name, scale = m * g, from = 1, measure = function() return rod:reaction() end,
            value = function() return m * g * share end }
end
expect { "the left rod", exact = "left", tolerance = 8e-06 }
expect { "the right rod", exact = "right", tolerance = 3.6e-06 }
