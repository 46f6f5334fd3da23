-- atwood.lua - 3 kg and 2 kg on a rope over a light pulley: a = g / 5, tension 2 m1 m2 g / (m1 + m2) = 2.4 g.
-- Source: Atwood 1784. Hard: what a joint pushes moves by h v in each substep: places lag by a h t / 2.
-- Aim: 1e-4 m.
scene { title = "Atwood's machine", duration = 1.5, description = "Two weights on one rope." }
local g = 9.81
local heavy = body { name = "heavy", box { 0.4, 0.4 }, at = {-0.5, 0}, mass = 3, color = 1 }
local light = body { name = "light", box { 0.4, 0.4 }, at = {0.5, 0}, mass = 2, color = 2 }
local rope = pulley { heavy, light, wheel_a = {-0.5, 4}, wheel_b = {0.5, 4} }
exact { "heavy", body = "heavy", x = function() return -0.5 end, y = function(t) return -g / 10 * t * t end }
exact { "tension", unit = "N", measure = function() return rope:reaction() end,
        value = function() return 2.4 * g end, from = 0.1 }
expect { "the way", exact = "heavy", tolerance = 2.2e-05 }
expect { "the tension", exact = "tension", tolerance = 0.00025 }
