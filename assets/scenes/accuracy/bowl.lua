-- bowl.lua - a disc rolls to and fro in a bowl of 4,000 pieces: phi'' = -2 g sin(phi) / 3 (R - r) by Runge-Kutta; its
-- amplitude stays. So many pieces, as each inner corner truly takes a share of the energy, which falls with their number; so fine, they are taken for chords of an arc.
-- Source: any textbook of mechanics; Routh. Hard: friction and normal of the step's beginning brake a disc that goes
-- round.
scene { title = "Rolling in a bowl", duration = 20, description = "A disc rolls in a bowl for 20 s." }
local g, big, r, start = 9.81, 2, 0.3, 0.7
local ring = big - r
local rough = material { friction = 1 }
local points = {}
for i = 0, 4000 do
    local u = -math.pi + math.pi * i / 4000
    points[i + 1] = { big * math.cos(u), big * math.sin(u) }
end
body { name = "bowl", type = "static", chain(points), material = rough }
local disc = body { name = "disc", circle { r }, at = {ring * math.sin(start), -ring * math.cos(start)}, material = rough,
        sleep = false }
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
local swing = solution(function(s) return { s[2], -2 / 3 * g / ring * math.sin(s[1]) } end, { start, 0 })
exact { "place", body = "disc", x = function(t) return ring * math.sin(swing(t)[1]) end,
        y = function(t) return -ring * math.cos(swing(t)[1]) end,
        till = 4 }
exact { "amplitude", at = 20, scale = start, value = function() return start end, measure = function()
    local _, y = disc:position()
    local v, w = disc:speed(), disc:spin()
    return math.acos(math.max(-1, -(y + (v * v + r * r * w * w / 2) / (2 * g)) / ring))
end }
expect { "the first 4 s", exact = "place", tolerance = 0.00013 }
expect { "the amplitude after 20 s", exact = "amplitude", tolerance = 0.00016 }
