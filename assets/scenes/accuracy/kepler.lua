-- kepler.lua - five turns of an orbit of eccentricity 0.5 about a fixed sun, by field{}: T = 2 pi sqrt(a^3 / mu),
-- E = -mu / (2 a). Places between by Kepler's equation M = u - e sin u (Newton's method).
-- Source: Kepler 1609; Goldstein, Classical Mechanics, ch. 3. Hard: a force that acts once a step, or in the substep but
-- for its beginning, does work: the orbit spirals out.
-- `--set once=1` shows that: apply_force once a step.
scene { title = "Kepler orbit", gravity = {0, 0}, duration = 31.4,
        description = "Five turns at e = 0.5 return to where they began." }
local mu, a, e = 1, 1, 0.5
local b = a * math.sqrt(1 - e * e)
body { name = "sun", type = "static", circle { 0.05 }, color = 1 }
local planet = body { name = "planet", circle { 0.03 }, at = {a * (1 + e), 0},
                      velocity = {0, math.sqrt(mu / a * (1 - e) / (1 + e))},
                      sleep = false, color = 2 }
local function pull(x, y)
    local r = math.sqrt(x * x + y * y)
    return -mu * x / (r * r * r), -mu * y / (r * r * r)
end
if param("once", 0, 0, 1) == 1 then
    every_step(function()
        local x, y = planet:position()
        local ax, ay = pull(x, y)
        planet:apply_force(planet:mass() * ax, planet:mass() * ay)
    end)
else
    field { body = "planet", pull }
end
local function eccentric(t) -- anomaly from the nearer apsis, half a turn earlier
    local m = math.sqrt(mu / (a * a * a)) * t + math.pi
    local u = m
    for _ = 1, 30 do u = u - (u - e * math.sin(u) - m) / (1 - e * math.cos(u)) end
    return u
end
exact { "place", body = "planet", x = function(t) return -a * (math.cos(eccentric(t)) - e) end,
        y = function(t) return -b * math.sin(eccentric(t)) end }
exact { "energy", scale = mu / (2 * a), value = function() return -mu / (2 * a) end, measure = function()
    local x, y = planet:position()
    local v = planet:speed()
    return v * v / 2 - mu / math.sqrt(x * x + y * y)
end }
expect { "the ellipse, five times", exact = "place", tolerance = 0.00081 }
expect { "the energy", exact = "energy", tolerance = 2.1e-05 }
