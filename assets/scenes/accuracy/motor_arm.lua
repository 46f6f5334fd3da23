-- motor_arm.lua - a motor of steady torque turns an arm about its centre: angle = T t^2 / 2 I.
-- Source: Euler 1765. Hard: what a joint pushes moves by h w in each substep: the angle lags by a h t / 2.
-- Aim: 1e-4 rad.
scene { title = "Motor and arm", gravity = {0, 0}, duration = 1.5, description = "A steady torque turns an arm." }
local torque = 3
local arm = body { name = "arm", box { 2, 0.1 }, mass = 3 }
local inertia = arm:inertia()
revolute { arm, at = {0, 0}, motor = { speed = 1000, torque = torque } }
exact { "angle", body = "arm", angle = function(t) return torque / inertia * t * t / 2 end }
expect { "the angle", exact = "angle", tolerance = 3.9e-05 }
