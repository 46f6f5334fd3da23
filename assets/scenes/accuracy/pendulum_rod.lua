-- pendulum_rod.lua - a uniform rod hinged at its end, let go at 60 degrees: theta'' = -3 g / 2 L sin(theta) by
-- Runge-Kutta.
-- Source: Huygens 1673: length of the equivalent pendulum 2 L / 3 (here with I of the box: L^2 + w^2 over 12). Hard: the
-- hinge bears and turns the body at once.
-- Aim: 1e-3 rad in six periods.
scene { title = "Physical pendulum", duration = 10, description = "A rod hinged at its end." }
local g, l, w, start = 9.81, 1, 0.1, math.pi / 3
local rod = body { name = "rod", box { w, l, at = {0, -l / 2} }, angle = start, sleep = false }
revolute { rod, at = {0, 0}, name = "hinge" }
local inertia = (l * l + w * w) / 12 + l * l / 4
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
local swing = solution(function(s) return { s[2], -g * l / 2 / inertia * math.sin(s[1]) } end, { start, 0 })
exact { "angle", body = "rod", angle = function(t) return swing(t)[1] end }
exact { "energy", scale = g * l / 2 * (1 - math.cos(start)), value = function() return -g * l / 2 * math.cos(start) end,
        measure = function() return inertia * rod:spin() * rod:spin() / 2 - g * l / 2 * math.cos(rod:angle()) end }
expect { "six periods", exact = "angle", tolerance = 0.00022 }
expect { "the energy", exact = "energy", tolerance = 0.00027 }
