-- crossed_fields.lua - a charge at rest in crossed fields, by field{}: a = (w vy, k - w vx); it drifts on a cycloid x = k
-- / w (t - sin(w t) / w), y = k / w^2 (1 - cos(w t)).
-- Source: Jackson, Classical Electrodynamics, 12.3. Hard: a force across the velocity must do no work.
scene { title = "Crossed fields", gravity = {0, 0}, duration = 10, description = "A charge drifts on a cycloid for 10 s." }
local w, k = 6, 3
body { name = "charge", circle { 0.05 }, sleep = false }
field { body = "charge", function(x, y, vx, vy) return w * vy, k - w * vx end }
exact { "place", body = "charge", x = function(t) return k / w * (t - math.sin(w * t) / w) end,
        y = function(t) return k / (w * w) * (1 - math.cos(w * t)) end }
expect { "the cycloid", exact = "place", tolerance = 0.0004 }
