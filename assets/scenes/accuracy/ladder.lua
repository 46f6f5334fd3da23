-- ladder.lua - a ladder slips down along a wall without friction: theta'' = 3 g sin(theta) / 2 L, by Runge-Kutta; it
-- leaves the wall when its top has come down to 2/3 of its height, and goes on with vx = sqrt(g L cos(start)^3) / 3.
-- Source: Kapranidis and Koo, Coll. Math. J. 39 (2008) 374. Hard: each end slides while the body turns; a contact's
-- geometry of the step's beginning holds or frees the end too long.
-- Aim: 1e-3 rad, 1e-3 m/s.
scene { title = "Ladder", duration = 2, description = "A ladder leaves its wall at two thirds of the height." }
local g, l, r, start = 9.81, 4, 0.05, 0.3 -- [rad] from the wall
local ice = material { friction = 0 }
body { name = "floor", type = "static", box { 24, 1 }, at = {5, -0.5 - r}, material = ice }
body { name = "wall", type = "static", box { 1, 12 }, at = {-0.5 - r, 6}, material = ice }
local ladder = body { name = "ladder", capsule { l, r }, at = {l / 2 * math.sin(start), l / 2 * math.cos(start)},
                      angle = math.pi / 2 + start, mass = 1, inertia = l * l / 12, material = ice, sleep = false }
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
local slide = solution(function(s) return { s[2], 1.5 * g / l * math.sin(s[1]) } end, { start, 0 })
local leaves = 0
while math.cos(slide(leaves)[1]) > 2 / 3 * math.cos(start) do leaves = leaves + 1 / 2400 end
local vx = math.sqrt(g * l * math.cos(start) * math.cos(start) * math.cos(start)) / 3
exact { "angle", body = "ladder", angle = function(t) return math.pi / 2 + slide(t)[1] end, till = leaves }
exact { "leaves", measure = function() local x = ladder:velocity() return x end, value = function() return vx end, unit = "m/s",
        from = leaves + 0.05, till = leaves + 0.2 }
expect { "the slide", exact = "angle", tolerance = 4.9e-05 }
expect { "leaves at two thirds", exact = "leaves", tolerance = 3.3e-05 }
