-- kepler_steep.lua - five turns of an orbit of eccentricity 0.9 about a fixed sun, by attractor{} and orbits{ order = 4 }. Places
-- between by Kepler's equation M = u - e sin u (Newton's method).
-- Source: Kepler 1609; Goldstein, Classical Mechanics, ch. 3. Hard: at the nearer apsis the body is nineteen times as fast,
-- and the pull 361 times as strong, as at the other.
scene { title = "Steep Kepler orbit", gravity = {0, 0}, duration = 31.4,
        description = "Five turns at e = 0.9 return to where they began." }
local mu, a, e = 1, 1, 0.9
local b = a * math.sqrt(1 - e * e)
attractor { strength = mu }
orbits { order = param("order", 4, 2, 4), tolerance = param("tol", 0.0, 0, 0.01) }
local planet = body { name = "planet", circle { 0.01 }, at = {a * (1 + e), 0},
                      velocity = {0, math.sqrt(mu / a * (1 - e) / (1 + e))}, sleep = false, color = 2 }
local function eccentric(t) -- anomaly from the nearer apsis, half a turn earlier
    local m = math.sqrt(mu / (a * a * a)) * t + math.pi
    local u = m
    for _ = 1, 60 do u = u - (u - e * math.sin(u) - m) / (1 - e * math.cos(u)) end
    return u
end
exact { "place", body = "planet", x = function(t) return -a * (math.cos(eccentric(t)) - e) end,
        y = function(t) return -b * math.sin(eccentric(t)) end }
exact { "energy", scale = mu / (2 * a), value = function() return -mu / (2 * a) end, measure = function()
    local x, y = planet:position()
    local v = planet:speed()
    return v * v / 2 - mu / math.sqrt(x * x + y * y)
end }
expect { "the ellipse, five times", exact = "place", tolerance = 1.4e-5 }
expect { "the energy", exact = "energy", tolerance = 4e-6 }
