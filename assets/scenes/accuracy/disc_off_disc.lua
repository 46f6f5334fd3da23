-- disc_off_disc.lua - a disc comes off the top of a fixed one, from 0.1 rad. Without friction phi'' = g sin(phi) / R, R between
-- the centres, and it leaves at cos(phi) = 2/3 cos(start); with friction 0.5 it rolls, phi'' = 2 g sin(phi) / 3 R, then slips
-- from where g sin(phi) / 3 exceeds friction times N = g cos(phi) - R phi'^2. It leaves where N = 0; from there vx stays.
-- Source: Lamb, Dynamics; Coulomb. Hard: the normal turns while the disc moves along it.
-- Aim: 1e-3 m, 1e-3 m/s.
scene { title = "Disc off a disc", duration = 2.4, description = "Where a disc leaves the one under it." }
local g, big, r, start = 9.81, 2, 0.5, 0.1
local ring = big + r
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
for i, case in ipairs { {"slides", 0}, {"rolls", 0.5} } do
    local name, mu = case[1], case[2]
    local x, m = 12 * i, material { friction = mu }
    body { name = name .. " below", type = "static", circle { big }, at = {x, 0}, material = m }
    local disc = body { name = name, circle { r }, at = {x + ring * math.sin(start), ring * math.cos(start)}, material = m,
                        sleep = false }
    local function load(s) return math.max(0, g * math.cos(s[1]) - ring * s[2] * s[2]) end
    local way = solution(function(s)
        local friction = math.min(g * math.sin(s[1]) / 3, mu * load(s))
        return { s[2], (g * math.sin(s[1]) - friction) / ring }
    end, { start, 0 })
    local leaves = 0
    while load(way(leaves)) > 0 do leaves = leaves + 1 / 2400 end
    local last = way(leaves)
    local vx = ring * last[2] * math.cos(last[1])
    assert(mu > 0 or math.abs(math.cos(last[1]) - 2 / 3 * math.cos(start)) < 2e-3)
    exact { name, body = name, x = function(t) return x + ring * math.sin(way(t)[1]) end,
            y = function(t) return ring * math.cos(way(t)[1]) end, till = leaves }
    exact { name .. ", off", measure = function() local u = disc:velocity() return u end, value = function() return vx end,
            unit = "m/s", from = leaves + 0.05, till = leaves + 0.2 }
end
expect { "slides along", exact = "slides", tolerance = 5.9e-05 }
expect { "leaves without friction", exact = "slides, off", tolerance = 0.00014 }
expect { "rolls along", exact = "rolls", tolerance = 5.9e-05 }
expect { "leaves with friction", exact = "rolls, off", tolerance = 0.00015 }
