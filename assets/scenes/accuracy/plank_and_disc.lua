-- plank_and_disc.lua - a plank on ice is pulled by F from under a disc that rolls on it: a = F / (M + m / 3), the disc's
-- centre has a third of that.
-- Source: any textbook of mechanics. Hard: friction between two that move.
-- Aim: 1e-3 m.
scene { title = "Plank and disc", duration = 1.5, description = "A disc rolls on a plank that is pulled away." }
local force, big, mass, r = 8, 2, 3, 0.5
body { name = "ground", type = "static", box { 80, 1 }, at = {0, -0.5}, material = material { friction = 0,
        friction_mix = "min" } }
local plank = body { name = "plank", box { 12, 0.4 }, at = {0, 0.2}, mass = big, material = material { friction = 0.9 },
        color = 1 }
body { name = "disc", circle { r }, at = {2, 0.4 + r}, mass = mass, material = material { friction = 0.9 }, color = 2 }
every_step(function() plank:apply_force(force, 0) end)
local a = force / (big + mass / 3)
exact { "plank", body = "plank", x = function(t) return a * t * t / 2 end }
exact { "disc", body = "disc", x = function(t) return 2 + a / 3 * t * t / 2 end }
expect { "the plank", exact = "plank", tolerance = 7e-05 }
expect { "the disc", exact = "disc", tolerance = 2.6e-05 }
