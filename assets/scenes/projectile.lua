-- projectile.lua - a stone thrown at 45 degrees: free flight, whose closed form is a parabola.
-- Shows: free flight is exact to rounding at any step; `plumb cost` measures against exact{}.
scene { title = "Projectile", description = "Free flight: the parabola is met to rounding.", duration = 3 }
camera { fit = {{-2, -2}, {47, 12.5}}, at = 2, trail = 2 }

local g, v = 9.81, 20
local vx, vy = v * math.cos(math.pi / 4), v * math.sin(math.pi / 4)
body { name = "ground", type = "static", box { 60, 1 }, at = {22, -1.5}, color = "#6b7f5a" }
body { name = "stone", circle { 0.4 }, at = {0, 0}, velocity = {vx, vy}, spin = 3, color = 1 }

exact {
    body = "stone",
    x = function(t) return vx * t end,
    y = function(t) return vy * t - g * t * t / 2 end,
    vx = function() return vx end,
    vy = function(t) return vy - g * t end,
    till = 2.8,
}
expect { "the parabola at 1 s", at = 1, body = "stone", position = {vx, vy - g / 2}, tolerance = 1e-4 }
expect { "the parabola at 2 s", at = 2, body = "stone", position = {2 * vx, 2 * vy - 2 * g}, tolerance = 2e-4 }
expect { "no energy is lost in flight", till = 2.8, energy_drift = 1e-5 }
