-- figure_eight.lua - three equal bodies chase one another on an eight, by mutual{} and orbits{ order = 4 }: after 6.32591398 s
-- each is where it was.
-- Source: Chenciner and Montgomery 2000, Ann. Math. 152; start and period as of Simo there. Hard: every force has its
-- reaction in the same moment, and the places of a period ago are known to eight digits.
scene { title = "Figure eight", gravity = {0, 0}, duration = 12.6519,
        description = "Three bodies on an eight return after each period." }
mutual { strength = 1 }
orbits { order = 4 }
local period = 6.32591398
local x, y, u, v = 0.97000436, -0.24308753, -0.93240737, -0.86473146
local function ball(name, at, velocity, color)
    return body { name = name, circle { 0.05 }, mass = 1, attraction = 1, at = at, velocity = velocity, color = color }
end
local a = ball("a", {x, y}, {-u / 2, -v / 2}, 1)
local b = ball("b", {-x, -y}, {-u / 2, -v / 2}, 2)
local c = ball("c", {0, 0}, {u, v}, 3)
local start = { {x, y}, {-x, -y}, {0, 0} }
-- How far they are from where they began, less the way since the period ended (a step is no divisor of it).
local function off()
    local worst, t = 0, time() - period * math.floor(time() / period + 0.5)
    for i, ball in ipairs { a, b, c } do
        local px, py = ball:position()
        local vx, vy = ball:velocity()
        local dx, dy = px - t * vx - start[i][1], py - t * vy - start[i][2]
        worst = math.max(worst, math.sqrt(dx * dx + dy * dy))
    end
    return worst
end
exact { "return", at = period * 2, value = function() return 0 end, measure = off, unit = "m" }
expect { "where they were, twice", exact = "return", tolerance = 3.3e-6 }
expect { "the energy", energy_drift = 2.6e-8 }
expect { "the momentum", momentum_drift = 1.7e-8 }
