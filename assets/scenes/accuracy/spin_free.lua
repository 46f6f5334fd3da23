-- spin_free.lua - an uneven body spins at 50 rad/s in flight: its centre of mass goes straight, its angle is w t.
-- Source: Euler's equations in the plane. Hard: a turn by atan(h w) instead of h w is 1.4 % slow; the frame's origin
-- circles around the centre of mass.
scene { title = "Free spin", gravity = {0, 0}, duration = 3, description = "A club spins about its centre of mass." }
local w, v = 50, 2
local club = body { name = "club", circle { 0.3, at = {1, 0} }, capsule { 2, 0.1 }, velocity = {v, 0}, spin = w, sleep = false }
local cx, cy = club:center()
exact { "angle", body = "club", angle = function(t) return w * t end }
exact { "origin", body = "club", x = function(t) return cx + v * t - cx * math.cos(w * t) end,
        y = function(t) return cy - cx * math.sin(w * t) end }
expect { "the angle", exact = "angle", tolerance = 6.8e-06 }
expect { "the origin circles", exact = "origin", tolerance = 3e-06 }
