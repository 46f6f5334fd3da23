-- limit_bounce.lua - limits and a rope with restitution. A weight on a slider that leans by 0.6 rad from upright falls 1 m to its
-- limit and rises to e^2n m: between blows x = v t - a t^2 / 2 along it, a = g cos 0.6. A ball falls into the end of a slack rope:
-- along it the speed turns round, across it stays. A rod on a hinge at its end comes back from a limit 60 degrees
-- below level to e^2 of the height.
-- Source: Newton 1687, with the moments of the blows by parabolas. Hard: the blow lies within a substep, and the rope and the
-- rod turn until then; the rod is struck about its hinge, not about its centre.
-- Aim: 1e-3 of the rod's energy.
scene { title = "Limits that bounce", duration = 2, description = "Restitution of limits and ropes." }
local g, e, lean = 9.81, 0.7, 0.6
local ux, uy, a = math.sin(lean), math.cos(lean), g * math.cos(lean)
local weight = body { name = "weight", box { 0.2, 0.2 }, at = {-6 + ux, uy}, sleep = false }
prismatic { weight, at = {-6 + ux, uy}, axis = {ux, uy}, limits = {-1, 9}, restitution = e }
local function height(t)
    local fall = math.sqrt(2 / a)
    if t < fall then return 1 - a * t * t / 2 end
    local v, rest = e * math.sqrt(2 * a), t - fall
    while rest > 2 * v / a do
        rest = rest - 2 * v / a
        v = v * e
    end
    return v * rest - a * rest * rest / 2
end
exact { "weight", body = "weight", x = function(t) return -6 + ux * height(t) end, y = function(t) return uy * height(t) end }
local x = 0.5
local h = math.sqrt(1 - x * x)
local v, fall = math.sqrt(2 * g * h), math.sqrt(2 * h / g)
local along = v * h
local ball = body { name = "ball", circle { 0.05 }, at = {x, 0}, sleep = false }
distance { world, ball, at_a = {0, 0}, at_b = {x, 0}, limits = {0, 1}, restitution = e }
exact { "ball", body = "ball", till = fall + 0.2,
        x = function(t) return t < fall and x or x - (1 + e) * along * x * (t - fall) end,
        y = function(t)
            if t < fall then return -g * t * t / 2 end
            local s = t - fall
            return -h + ((1 + e) * along * h - v) * s - g * s * s / 2
        end }
local l, d, bound = 1, 0.1, math.pi / 3
local rod = body { name = "rod", box { l, d }, at = {4 + l / 2, 0}, sleep = false }
revolute { rod, at = {4, 0}, limits = {-bound, 2}, restitution = e }
local inertia = (l * l + d * d) / 12 + l * l / 4
exact { "rod", at = 0.8, value = function() return e * e end, measure = function()
    local w, angle = rod:spin(), rod:angle()
    return (inertia * w * w / 2 + g * l / 2 * (math.sin(angle) + math.sin(bound))) / (g * l / 2 * math.sin(bound))
end }
expect { "the weight", exact = "weight", tolerance = 1.6e-05 }
expect { "the ball", exact = "ball", tolerance = 8.1e-7 }
expect { "the rod", exact = "rod", tolerance = 0.00079 }
