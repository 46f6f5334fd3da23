-- pendulum_spring.lua - a mass on an undamped spring of 1 Hz swings and bounces: r'' = r theta'^2 + g cos(theta) - w^2 (r
-- - l), theta'' = -(g sin(theta) + 2 r' theta') / r, by Runge-Kutta.
-- Source: Vitt and Gorelik 1933. Hard: energy goes to and fro between two modes; the spring must not damp.
-- Aim: 1e-2 m.
scene { title = "Spring pendulum", duration = 6, description = "A mass on a spring swings and bounces." }
local g, l, w, start = 9.81, 1, 2 * math.pi, 0.5
local bob = body { name = "bob", circle { 0.1 }, at = {l * math.sin(start), -l * math.cos(start)}, sleep = false }
distance { world, bob, at_a = {0, 0}, length = l, spring = { frequency = 1, damping = 0 } }
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
    local r, a, u, p = s[1], s[2], s[3], s[4]
    return { u, p, r * p * p + g * math.cos(a) - w * w * (r - l), -(g * math.sin(a) + 2 * u * p) / r }
end, { l, start, 0, 0 })
exact { "place", body = "bob", x = function(t) return swing(t)[1] * math.sin(swing(t)[2]) end,
        y = function(t) return -swing(t)[1] * math.cos(swing(t)[2]) end }
expect { "6 s", exact = "place", tolerance = 9.4e-05 }
