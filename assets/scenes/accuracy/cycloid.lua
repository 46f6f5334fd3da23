-- cycloid.lua - discs slide without friction in a cycloid of 4,000 pieces (offset by their radius):
-- s = s0 cos(t sqrt(g / 4 a)), so all come to the bottom after pi sqrt(a / g), from any height.
-- Source: Huygens, Horologium oscillatorium, 1673. Hard: a normal that turns along the way; inner corners of coarser
-- pieces truly take energy.
-- Aim: 1e-3 m in one period.
scene { title = "Tautochrone", duration = 4, description = "From any height in the same time to the bottom." }
local g, a, r = 9.81, 1, 0.05
local ice = material { friction = 0 }
local points = {}
for i = 0, 4000 do
    local u = (i / 2000 - 1) * 2.9
    local c, s = math.cos(u / 2), math.sin(u / 2)
    points[i + 1] = { a * (u + math.sin(u)) + r * s, a * (1 - math.cos(u)) - r * c }
end
body { name = "cycloid", type = "static", chain(points), material = ice }
for i, s0 in ipairs { 3.4, 1.5 } do
    local function at(t)
        local s = -s0 * math.cos(t * math.sqrt(g / (4 * a))) / (4 * a) -- sin(u / 2)
        local u = 2 * math.asin(s)
        return a * (u + math.sin(u)), a * (1 - math.cos(u))
    end
    local x, y = at(0)
    local name = "disc" .. i
    local disc = body { name = name, circle { r }, at = {x, y}, material = ice, apart = "discs", sleep = false }
    exact { name, body = name, x = function(t) local px = at(t) return px end, y = function(t) local _, py = at(t) return py end }
end
expect { "from high", exact = "disc1", tolerance = 0.0011 }
expect { "from low", exact = "disc2", tolerance = 9.5e-05 }
