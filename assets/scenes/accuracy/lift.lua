-- lift.lua - a lift that starts and stops smoothly by way D in the time T: x = D (3 s^2 - 2 s^3), s = t / T, x'' = 6 D (1 - 2 s) / T^2; what stands on it
-- is borne by m (g + x''), and goes with it. Beside it a rotor on which a weight is welded, that turns as smoothly.
-- Source: Newton; cubic keyframes (Hermite). Hard: the load changes in every substep, and jumps as the lift starts.
-- Aim: 1e-4 m, 1e-4 of the weight.
scene { title = "Lift", duration = 2, description = "A lift and a rotor start and stop smoothly and carry what is on them." }
camera { fit = {{-3, -2}, {8, 6}} }
local g, D, T, turn, r = 9.81, 3, 2, 3, 1.5
local function share(t) local s = math.min(t / T, 1) return 3 * s * s - 2 * s * s * s end
local lift = body { name = "lift", type = "kinematic", box { 3, 0.5 }, at = {0, -0.25} }
local crate = body { name = "crate", box { 1, 1 }, at = {0, 0.5}, sleep = false }
local load = body { name = "load", circle { 0.25 }, mass = 1, at = {-1.2, 0.5}, sleep = false }
local arm = weld { lift, load, at = {-1.2, 0.5} }
local rotor = body { name = "rotor", type = "kinematic", circle { 0.2, sensor = true }, at = {5, 2} }
local weight = body { name = "weight", circle { 0.2 }, at = {5 + r, 2}, gravity_scale = 0, sleep = false }
weld { rotor, weight, at = {5 + r, 2} }
at(0, function()
    lift:move_to(0, -0.25 + D, 0, T, 0, 0)
    rotor:move_to(5, 2, turn, T, 0, 0, 0)
end)
exact { "place", body = "crate", y = function(t) return 0.5 + D * share(t) end }
exact { "weight", body = "weight", x = function(t) return 5 + r * math.cos(turn * share(t)) end,
    y = function(t) return 2 + r * math.sin(turn * share(t)) end }
exact { "force", scale = g, from = 0.05, measure = function() return arm:reaction() end, value = function(t)
    return g + 6 * D * (1 - 2 * (t - 1 / 480) / T) / (T * T) -- forces are means of the last substep
end }
expect { "the crate", exact = "place", tolerance = 0.000104 }
expect { "the weight on the rotor", exact = "weight", tolerance = 2.1e-05 }
expect { "the load's force", exact = "force", tolerance = 3e-05 }
