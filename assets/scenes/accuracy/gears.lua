-- gears.lua - a torque on a wheel that drives a second one, three times slower: a = T / (I1 + I2 / 9), and a rack that a
-- pinion of radius r drives with a weight: y'' = m g / (m + I / r^2).
-- Source: any textbook of machines. Hard: two inertias behind one row; lag of what joints push.
-- Aim: 1e-4.
scene { title = "Gears", duration = 1.5, description = "Two wheels geared 3 : 1; a weight on a rack." }
local g, torque = 9.81, 6
local function disc(name, x, r, m) return body { name = name, circle { r }, at = {x, 0}, mass = m, apart = "all" } end
local small, large = disc("small", 0, 0.3, 1), disc("large", 1.2, 0.9, 9)
local a = torque / (small:inertia() + large:inertia() / 9)
local drive = revolute { small, motor = { speed = 1000, torque = torque } }
gear { drive, revolute { large }, ratio = 3 }
local pinion, weight = disc("pinion", 4, 0.5, 4), body { name = "weight", box { 0.2, 1 }, at = {4.6, 0}, mass = 2, apart = "all" }
gear { revolute { pinion }, prismatic { weight, axis = {0, 1} }, ratio = 1 / 0.5 }
local fall = 2 * g / (2 + pinion:inertia() / 0.25)
exact { "wheel", body = "small", angle = function(t) return a * t * t / 2 end, till = 0.7 }
exact { "rack", body = "weight", x = function() return 4.6 end, y = function(t) return -fall * t * t / 2 end }
expect { "the driving wheel", exact = "wheel", tolerance = 0.0005 }
expect { "the rack", exact = "rack", tolerance = 3.3e-05 }
