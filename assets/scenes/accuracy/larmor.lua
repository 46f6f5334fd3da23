-- larmor.lua - a charge circles in a uniform magnetic field, another drifts across an electric one, by magnetic{} and zone{}: radius
-- m v / (q B), period 2 pi m / (q B), drift E / B; x = k / w (t - sin(w t) / w), y = k / w^2 (1 - cos(w t)), w = q B / m, k = q
-- E / m.
-- Source: Jackson, Classical Electrodynamics, 12.2 and 12.3. Hard: a force across the velocity must do no work, nor may a
-- turn lag.
scene { title = "Larmor circle and drift", gravity = {0, 0}, duration = 10,
        description = "A charge on a circle, another on a cycloid, for 10 s." }
local w, k, v = 6, 3, 4
magnetic { strength = w }
zone { electric = {0, k}, only = "drifts" }
body { name = "circles", circle { 0.05 }, mass = 2, charge = 2, at = {0, 3}, velocity = {v, 0}, color = 1, sleep = false }
body { name = "drifts", circle { 0.05, category = "drifts" }, mass = 1, charge = 1, color = 2, sleep = false }
exact { "circle", body = "circles", x = function(t) return v / w * math.sin(w * t) end,
        y = function(t) return 3 - v / w * (1 - math.cos(w * t)) end }
exact { "cycloid", body = "drifts", x = function(t) return k / w * (t - math.sin(w * t) / w) end,
        y = function(t) return k / (w * w) * (1 - math.cos(w * t)) end }
expect { "the circle", exact = "circle", tolerance = 3.2e-6 }
expect { "the cycloid", exact = "cycloid", tolerance = 1.1e-6 }
