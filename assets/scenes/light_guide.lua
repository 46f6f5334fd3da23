-- Rays of light in glass: a ball that focuses, a prism, and a bent rod that light cannot leave. The lighthouse turns once in eight seconds;
-- when it looks into the rod, its light comes out at the other end, two bends later.
scene { title = "Light guide", gravity = {0, 0}, duration = 8 }

local N = 1.5
local glass = material { refractive_index = N }
local tinted = material { refractive_index = N, absorption = 0.35 }

-- A ball of radius R focuses at n R / (2 (n - 1)) from its middle.
local R = 1
body { name = "ball", type = "static", circle { R }, at = {-3, 3}, material = glass }
body { name = "pin", type = "static", circle { 0.05 }, at = {-3 + N * R / (2 * (N - 1)), 3} }
light { name = "sun", at = {-6, 3}, width = 0.3, rays = 7, color = "#e09a10", least = 0.05 }
light { name = "wide", at = {-6, 3}, width = 1.7, rays = 8, length = 5.4, color = "#b1579c", least = 0.05 }

-- Tinted glass takes e^(-absorption x) of it.
body { name = "filter", type = "static", box { 1.2, 1.6 }, at = {3.6, 3}, material = tinted }
body { name = "screen", type = "static", box { 0.2, 2.6 }, at = {6.4, 3} }
light { name = "straight", at = {1.4, 3.6}, color = "#3b7dd8", least = 0.02 }
light { name = "slanted", at = {1.4, 1.9}, angle = 0.3, color = "#3b7dd8", polarization = 1, least = 0.02 }

-- One material that overlaps is one piece of glass.
local rod = {}
local function bend(x, y, from, to)
    local steps = 24
    for i = 1, steps do
        local a, b = from + (to - from) * (i - 1) / steps, from + (to - from) * i / steps
        local ax, ay = x + 1.4 * math.cos(a), y + 1.4 * math.sin(a)
        local bx, by = x + 1.4 * math.cos(b), y + 1.4 * math.sin(b)
        local length = math.sqrt((bx - ax)^2 + (by - ay)^2)
        table.insert(rod, capsule { length, 0.16, at = {(ax + bx) / 2, (ay + by) / 2}, angle = math.atan(by - ay, bx - ax), material = glass })
    end
end
local half = math.pi / 2
table.insert(rod, box { 1.8, 0.32, at = {-1.9, -0.8}, material = glass })
bend(-1, -2.2, half, 0)
bend(1.8, -2.2, -math.pi, -half)
table.insert(rod, box { 2.6, 0.32, at = {3.1, -3.6}, material = glass })
rod.name, rod.type = "rod", "static"
body(rod)
body { name = "eye", type = "static", box { 0.2, 0.8 }, at = {5.4, -3.6}, color = "#3aa655" }

body { name = "lighthouse", type = "kinematic", circle { 0.3 }, at = {-4.5, -0.8}, angle = -half, spin = math.pi / 4 }
light { name = "beacon", body = "lighthouse", at = {0.3, 0}, color = "#e5302a", least = 0.004 }

expect { "the ball focuses on the pin", at = 0, test = function()
    local kept = light_on("pin", "sun")
    return kept > 0.9 and kept <= 0.9217, kept, 0.9217
end }
expect { "what is far off the axis misses it", at = 0, test = function()
    local kept = light_on("pin", "wide")
    return kept < 0.7, kept, 0.7
end }
-- Two faces at a right angle, 1.2 m between them.
local THROUGH = 0.96 * math.exp(-0.35 * 1.2) * 0.96
expect { "tinted glass leaves its share", at = 0, test = function()
    local path = light_path("straight")
    local measured = path[3].power
    return math.abs(measured - THROUGH) < 1e-5, measured, THROUGH
end }
expect { "the eye is dark while the beacon looks elsewhere", from = 4, till = 7.5, test = function()
    local kept = light_on("eye", "beacon")
    return kept < 1e-6, kept, 1e-6
end }
expect { "the rod leads its light round two bends", at = 2, test = function()
    local kept = light_on("eye", "beacon")
    return kept > 0.85, kept, 0.85
end }
camera { fit = {{-6.6, -4.4}, {6.8, 5}}, at = 2 }
