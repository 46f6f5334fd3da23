-- rod_strike.lua - a rod at 30 degrees strikes the floor at 3 m/s with e = 0.5, without friction or gravity: J = (1 + e) v
-- / (1 / m + x^2 / I), x the lever of the end; v' = -v + J / m, w' = x J / I.
-- Source: Routh, Dynamics of a System of Rigid Bodies. Hard: lever and moment of the blow.
-- Aim: 1e-3.
scene { title = "Rod strikes floor", gravity = {0, 0}, duration = 0.5, description = "A blow at the end of a rod." }
local v, e, l, r, angle = 3, 0.5, 1, 0.02, math.pi / 6
local m = material { friction = 0, restitution = e }
body { name = "floor", type = "static", box { 10, 1 }, at = {0, -0.5}, material = m }
local rod = body { name = "rod", capsule { l, r }, at = {0, 1}, angle = -angle, velocity = {0, -v}, material = m }
local x = l / 2 * math.cos(angle) -- the right end is the lower one
local j = (1 + e) * v / (1 / rod:mass() + x * x / rod:inertia())
exact { "velocity", body = "rod", vx = function() return 0 end, vy = function() return -v + j / rod:mass() end, from = 0.26,
        till = 0.3 }
exact { "spin", body = "rod", spin = function() return x * j / rod:inertia() end, from = 0.26, till = 0.3 }
expect { "the velocity", exact = "velocity", tolerance = 1.5e-06 }
expect { "the spin", exact = "spin", tolerance = 2.1e-06 }
