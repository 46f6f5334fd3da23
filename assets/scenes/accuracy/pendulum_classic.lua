-- pendulum_classic.lua - a hinged pendulum let go at 90 degrees under the classic solver, for 60 s: it comes back to 90
-- degrees. What is measured is the largest angle that its energy still reaches.
-- Source: conservation of energy. Hard: the classic solver takes one step of first order and corrects places apart.
-- Aim: 1 % of the amplitude.
scene { title = "Pendulum, classic solver", duration = 60, solver = "pgs",
        description = "90 degrees, for 60 s, with the classic solver." }
local g, l = 9.81, 1
local bob = body { name = "bob", circle { 0.1 }, at = {l, 0}, sleep = false }
revolute { bob, at = {0, 0} }
exact { "amplitude", unit = "rad", at = 60, value = function() return math.pi / 2 end, measure = function()
    local _, y = bob:center()
    local w = bob:spin()
    local inertia = bob:inertia() / bob:mass() + l * l
    local rise = math.min(1, math.max(-1, (inertia * w * w / 2 + g * y) / (g * l)))
    return math.acos(-rise)
end }
expect { "the amplitude after 60 s", exact = "amplitude", tolerance = 1.7 }
