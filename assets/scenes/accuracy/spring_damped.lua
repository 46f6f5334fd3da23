-- spring_damped.lua - springs of 5 Hz with damping ratios 0.1, 1 and 2 let go at A: with w = 2 pi f,
-- under:    e^(-z w t) (cos(q t) + z w / q sin(q t)) A, q = w sqrt(1 - z^2)
-- critical: (1 + w t) e^(-w t) A
-- over:     (s1 e^(s2 t) - s2 e^(s1 t)) / (s1 - s2) A, s = w (-z +- sqrt(z^2 - 1))
-- Source: any textbook of mechanics. Hard: overdamped springs are stiff: two rates that differ 14 times.
scene { title = "Damped springs", gravity = {0, 0}, duration = 1.5,
        description = "Springs below, at and above critical damping." }
local a, w = 0.5, 2 * math.pi * 5
local function way(z)
    if z < 1 then
        local q = w * math.sqrt(1 - z * z)
        return function(t) return a * math.exp(-z * w * t) * (math.cos(q * t) + z * w / q * math.sin(q * t)) end
    elseif z == 1 then
        return function(t) return a * (1 + w * t) * math.exp(-w * t) end
    end
    local root = math.sqrt(z * z - 1)
    local s1, s2 = w * (-z + root), w * (-z - root)
    return function(t) return a * (s1 * math.exp(s2 * t) - s2 * math.exp(s1 * t)) / (s1 - s2) end
end
for i, case in ipairs { {"under", 0.1}, {"critical", 1}, {"over", 2} } do
    local name, z = case[1], case[2]
    local mass = body { name = name, box { 0.4, 0.4 }, at = {a, i}, sleep = false }
    prismatic { mass, at = {0, i}, axis = {1, 0}, spring = { frequency = 5, damping = z, rest = -a } }
    exact { name, body = name, x = way(z), y = function() return i end, scale = a }
end
expect { "under", exact = "under", tolerance = 1.2e-06 }
expect { "critical", exact = "critical", tolerance = 3.7e-07 }
expect { "over", exact = "over", tolerance = 1.8e-07 }
