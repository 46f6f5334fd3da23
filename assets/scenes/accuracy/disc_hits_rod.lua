-- disc_hits_rod.lua - a disc hits a free rod off its centre, e = 1, no friction: J = 2 v / (1 / m + 1 / M + d^2 / I).
-- Source: Routh. Hard: two bodies, a lever; momentum, angular momentum and energy all stay.
-- Aim: 1e-3.
scene { title = "Disc hits rod", gravity = {0, 0}, duration = 0.6, description = "A disc hits a rod off its centre." }
local v, d = 8, 0.35
local steel = material { friction = 0, restitution = 1 }
local rod = body { name = "rod", box { 0.1, 1 }, at = {0, 0}, material = steel, color = 1 }
local disc = body { name = "disc", circle { 0.1 }, at = {-1, d}, velocity = {v, 0}, material = steel, color = 2 }
local m, big, inertia = disc:mass(), rod:mass(), rod:inertia()
local j = 2 * v / (1 / m + 1 / big + d * d / inertia)
exact { "disc", body = "disc", vx = function() return v - j / m end, vy = function() return 0 end, from = 0.15 }
exact { "rod", body = "rod", vx = function() return j / big end, vy = function() return 0 end, from = 0.15 }
exact { "spin", body = "rod", spin = function() return -d * j / inertia end, from = 0.15 }
expect { "the disc", exact = "disc", tolerance = 2.9e-07 }
expect { "the rod", exact = "rod", tolerance = 1.4e-07 }
expect { "the rod's spin", exact = "spin", tolerance = 7.2e-07 }
