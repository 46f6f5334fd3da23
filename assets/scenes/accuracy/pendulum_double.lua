-- pendulum_double.lua - two equal rods, hinged one below the other, let go at 60 and 0 degrees: Lagrange's equations by
-- Runge-Kutta.
-- Source: Landau and Lifshitz, Mechanics, 5, with uniform rods: m l^2 / 6 (8 a'' + 3 b'' cos(a - b) + 3 b'^2 sin(a - b) +
-- 9 g / l sin a) = 0, m l^2 / 6 (2 b'' + 3 a'' cos(a - b) - 3 a'^2 sin(a - b) + 3 g / l sin b) = 0. Hard: errors grow with
-- time; 5 s stay below the onset of chaos.
-- Aim: 1e-2 m.
-- lint: allow size: the rods of the formula have no width
scene { title = "Double pendulum", duration = 5, description = "Two rods, 5 s." }
local g, l, start = 9.81, 1, math.pi / 3
local s0, c0 = math.sin(start), math.cos(start)
local upper = body { name = "upper", box { 0.001, l, at = {0, -l / 2} }, angle = start, mass = 1, inertia = l * l / 12,
        sleep = false, apart = "p" }
local lower = body { name = "lower", box { 0.001, l, at = {0, -l / 2} }, at = {l * s0, -l * c0}, mass = 1,
        inertia = l * l / 12, sleep = false,
                     apart = "p" }
revolute { upper, at = {0, 0} }
revolute { upper, lower, at = {l * s0, -l * c0} }
-- Runge-Kutta of fourth order in steps of at most 1/2400 s, ten times finer than the substeps and independent of the engine.
local function solution(rates, start)
    local time, s = 0, start
    local function moved(k, h)
        local out = {}
        for i = 1, #s do out[i] = s[i] + h * k[i] end
        return out
    end
    return function(t)
        if t < time then time, s = 0, start end
        while time < t - 1e-12 do
            local h = math.min(1 / 2400, t - time)
            local k1 = rates(s)
            local k2 = rates(moved(k1, h / 2))
            local k3 = rates(moved(k2, h / 2))
            local k4 = rates(moved(k3, h))
            local sum = {}
            for i = 1, #s do sum[i] = (k1[i] + 2 * k2[i] + 2 * k3[i] + k4[i]) / 6 end
            s, time = moved(sum, h), time + h
        end
        return s
    end
end
local swing = solution(function(s)
    local a, b, p, q = s[1], s[2], s[3], s[4]
    local c, d = math.cos(a - b), math.sin(a - b)
    local r1 = -3 * q * q * d - 9 * g / l * math.sin(a)
    local r2 = 3 * p * p * d - 3 * g / l * math.sin(b)
    local det = 16 - 9 * c * c
    return { p, q, (2 * r1 - 3 * c * r2) / det, (8 * r2 - 3 * c * r1) / det }
end, { start, 0, 0, 0 })
exact { "elbow", body = "lower", x = function(t) return l * math.sin(swing(t)[1]) end,
        y = function(t) return -l * math.cos(swing(t)[1]) end }
exact { "lower", body = "lower", angle = function(t) return swing(t)[2] end }
exact { "energy", unit = "J", value = function() return -g * l * (1.5 * c0 + 0.5) end, measure = function()
    local kinetic, potential = energy()
    return kinetic + potential
end }
expect { "the elbow", exact = "elbow", tolerance = 0.04 }
expect { "the lower rod", exact = "lower", tolerance = 0.096 }
expect { "the energy", exact = "energy", tolerance = 0.11 }
