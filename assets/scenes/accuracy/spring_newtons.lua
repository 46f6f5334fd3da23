-- spring_newtons.lua - springs told in N/m and N s/m. The same one holds 1 and 4 kg: x = A cos(w t), w = sqrt(k / m), damped
-- x = A e^(-p t) (cos(q t) + p / q sin(q t)), p = c / 2 m, q = sqrt(w^2 - p^2); a rod on a hinge of k N m/rad turns
-- with w = sqrt(k / (I + m r^2)): s / w sin(w t); a sled with a damper alone goes v m / c (1 - e^(-c t / m)).
-- Source: Hooke 1678; any textbook of mechanics. Hard: stiffness by the mass that a joint's row meets, which for the rod is
-- not what turns.
scene { title = "Springs in newtons", gravity = {0, 0}, duration = 4,
        description = "Stiffness and damping as forces, whatever they act on." }
local a, k, c = 0.5, 40, 4
for i, kg in ipairs { 1, 4 } do
    local name = kg .. " kg"
    local mass = body { name = name, box { 0.5, 0.5 }, at = {a, i}, mass = kg, sleep = false }
    local p = i == 1 and 0 or c / (2 * kg)
    local q = math.sqrt(k / kg - p * p)
    prismatic { mass, at = {0, i}, axis = {1, 0}, spring = { stiffness = k, damper = 2 * kg * p, rest = -a } }
    exact { name, body = name, scale = a, y = function() return i end,
            x = function(t) return a * math.exp(-p * t) * (math.cos(q * t) + p / q * math.sin(q * t)) end }
end
local m, r, l, d, s = 3, 0.5, 1, 0.1, 0.4
local rod = body { name = "rod", box { l, d }, at = {r, 3}, mass = m, velocity = {0, s * r}, spin = s, sleep = false }
revolute { rod, at = {0, 3}, spring = { stiffness = k } }
local w = math.sqrt(k / (m * (l * l + d * d) / 12 + m * r * r))
exact { "rod", body = "rod", angle = function(t) return s / w * math.sin(w * t) end, scale = s / w }
local sled = body { name = "sled", box { 0.5, 0.5 }, at = {0, 4}, mass = 2, velocity = {2, 0}, sleep = false }
prismatic { sled, at = {0, 4}, axis = {1, 0}, spring = { damper = c } }
exact { "sled", body = "sled", x = function(t) return 4 / c * (1 - math.exp(-c * t / 2)) end, y = function() return 4 end }
expect { "1 kg", exact = "1 kg", tolerance = 6.4e-06 }
expect { "4 kg", exact = "4 kg", tolerance = 8e-7 }
expect { "the rod", exact = "rod", tolerance = 8.1e-3 }
expect { "the sled", exact = "sled", tolerance = 6.2e-07 }
