-- pendulum_point.lua - a mass on a light rod, let go at 90 degrees: theta'' = -g / L sin(theta) by Runge-Kutta; the period
-- is T = 2 pi sqrt(L / g) / agm(1, cos(45 deg)) = 1.180341 times that of small swings.
-- Source: Huygens 1673; the mean of Gauss. Hard: rods stretch, and drag energy out or in.
-- Aim: 1e-3 m in five periods.
scene { title = "Point pendulum", duration = 10, description = "A mass on a rod, let go at 90 degrees." }
local g, l = 9.81, 1
local bob = body { name = "bob", circle { 0.1 }, at = {l, 0}, inertia = 1e-6, sleep = false }
distance { world, bob, at_a = {0, 0} }
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
local swing = solution(function(s) return { s[2], -g / l * math.sin(s[1]) } end, { math.pi / 2, 0 })
exact { "place", body = "bob", x = function(t) return l * math.sin(swing(t)[1]) end,
        y = function(t) return -l * math.cos(swing(t)[1]) end }
exact { "energy", scale = g * l, value = function() return 0 end, measure = function()
    local _, y = bob:position()
    local v = bob:speed()
    return v * v / 2 + g * y
end }
expect { "five periods", exact = "place", tolerance = 0.00036 }
expect { "the energy", exact = "energy", tolerance = 0.00036 }
