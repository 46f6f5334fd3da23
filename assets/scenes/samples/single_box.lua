-- single_box.lua - a box is thrown along the ground at 5 m/s. Friction brakes it at mu g: it stops after v^2 / (2 mu g),
-- upright, and falls asleep.
scene { title = "Single box", duration = 4 }
camera { fit = {{-3, -1.5}, {7, 3}}, at = 1, trail = 1 }
local v, mu = param("v", 5, 0, 20), 0.6
body { type = "static", box { 60, 1 }, at = {0, -0.5} }
local crate = body { name = "crate", box { 1, 1 }, at = {0, 0.5}, velocity = {v, 0}, color = 1 }
local way = v * v / (2 * mu * 9.81)
expect { "it stops after v^2 / (2 mu g)", body = "crate", x = way, tolerance = 0.02 * way + 0.01 }
expect { "it is at rest after v / (mu g)", from = v / (mu * 9.81) + 0.1, max_speed = 0.01 }
expect { "it never tips nor sinks", always = true, body = "crate", angle = {-0.01, 0.01}, y = {0.49, 0.505} }
expect { "it sleeps", test = function() return not crate:awake(), crate:awake() and 1 or 0, 0 end }
