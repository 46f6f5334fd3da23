-- bead_on_rod.lua - a bead on a rod that turns evenly, without gravity: r = r0 cosh(w t), force across 2 m w r'.
-- Source: Goldstein, Classical Mechanics, ch. 1. Hard: a guide that turns 57 degrees a second; growth doubles errors.
-- Aim: 1e-3 m.
scene { title = "Bead on a turning rod", gravity = {0, 0}, duration = 2,
        description = "A bead flies outwards along a turning rod." }
local w, r0 = 1, 1
local rod = body { name = "rod", type = "kinematic", box { 8, 0.02 }, spin = w, apart = "all" }
local bead = body { name = "bead", circle { 0.1 }, at = {r0, 0}, velocity = {0, r0 * w}, spin = w, mass = 1, apart = "all" }
local guide = prismatic { rod, bead, axis = {1, 0} }
local function cosh(u) return (math.exp(u) + math.exp(-u)) / 2 end
local function sinh(u) return (math.exp(u) - math.exp(-u)) / 2 end
exact { "place", body = "bead", x = function(t) return r0 * cosh(w * t) * math.cos(w * t) end,
        y = function(t) return r0 * cosh(w * t) * math.sin(w * t) end }
exact { "force", unit = "N", measure = function() return guide:reaction() end, from = 0.1,
        value = function(t) return 2 * w * w * r0 * sinh(w * (t - 1 / 480)) end }
expect { "the spiral", exact = "place", tolerance = 0.00079 }
expect { "the guide's force", exact = "force", tolerance = 0.002 }
