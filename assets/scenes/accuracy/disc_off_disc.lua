-- disc_off_disc.lua - a disc slides off the top of a fixed one, from 0.1 rad: it leaves where cos(phi) = 2/3 cos(start);
-- one that rolls, where 4/7. From there vx = sqrt(g R) cos(phi)^1.5 stays, R between the centres.
-- Source: Lamb, Dynamics: energy, and a force of zero. Hard: the normal turns while the disc moves along it.
-- Aim: 1e-3 m/s.
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
for i, case in ipairs { {"slides", 0, 1, 2 / 3}, {"rolls", 10, 2 / 3, 4 / 7} } do
    local name, mu, share, cosine = case[1], case[2], case[3], case[4] * math.cos(start)
    local x, m = 12 * i, material { friction = mu }
    body { name = name .. " below", type = "static", circle { big }, at = {x, 0}, material = m }
    local disc = body { name = name, circle { r }, at = {x + ring * math.sin(start), ring * math.cos(start)}, material = m,
            sleep = false }
    local way = solution(function(s) return { s[2], share * g / ring * math.sin(s[1]) } end, { start, 0 })
    local leaves = 0
    while math.cos(way(leaves)[1]) > cosine do leaves = leaves + 1 / 2400 end
    local vx = math.sqrt(g * ring * cosine) * cosine
    exact { name, body = name, x = function(t) return x + ring * math.sin(way(t)[1]) end,
            y = function(t) return ring * math.cos(way(t)[1]) end,
            till = leaves }
    exact { name .. ", off", measure = function() local u = disc:velocity() return u end,
            value = function() return vx end, unit = "m/s",
            from = leaves + 0.05, till = leaves + 0.2 }
end
expect { "slides along", exact = "slides", tolerance = 0.03 }
expect { "leaves at 2/3", exact = "slides, off", tolerance = 0.042 }
expect { "rolls along", exact = "rolls", tolerance = 0.015 }
expect { "leaves at 4/7", exact = "rolls, off", tolerance = 0.067 }
