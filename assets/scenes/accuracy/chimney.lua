-- chimney.lua - a hinged rod falls from 0.1 rad off the vertical: w^2 = 3 g (cos a0 - cos a) / L; its hinge bears N along
-- = m g (5 cos a - 3 cos a0) / 2 and N across = m g sin(a) / 4.
-- Source: Varieschi and Kamiya, Am. J. Phys. 71 (2003) 1025. Hard: forces of a joint that moves fast.
-- Aim: 1e-3 rad, 1e-2 of the weight.
-- lint: allow size: the rod of the formula has no width
scene { title = "Falling chimney", duration = 1.2, description = "A hinged rod falls; what its hinge bears." }
local g, l, start = 9.81, 2, 0.1
local rod = body { name = "rod", box { 0.001, l, at = {0, l / 2} }, angle = start, mass = 1, inertia = l * l / 12, sleep = false }
local hinge = revolute { rod, at = {0, 0}, name = "hinge" }
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
local function rates(s) return { s[2], 1.5 * g / l * math.sin(s[1]) } end
local fall, earlier = solution(rates, { start, 0 }), solution(rates, { start, 0 })
exact { "angle", body = "rod", angle = function(t) return fall(t)[1] end }
exact { "force", scale = g, measure = function() return hinge:reaction() end, from = 0.05, value = function(t)
    local a = earlier(t - 1 / 480)[1] -- forces are means of the last substep
    local along, across = g * (5 * math.cos(a) - 3 * math.cos(start)) / 2, g * math.sin(a) / 4
    return math.sqrt(along * along + across * across)
end }
expect { "the fall", exact = "angle", tolerance = 3e-05 }
expect { "the hinge's force", exact = "force", tolerance = 4.2e-05 }
