-- incline.lua - blocks on an incline of 20 degrees: a = g (sin - mu cos), and none from mu = tan(20 deg) = 0.364 on.
-- Source: Coulomb 1785. Hard: at mu = 0.37 the block must not creep, nor when it cannot turn; what rests must tip its load forward.
-- Aim: 1e-3 m sliding, 1e-5 m sticking.
scene { title = "Incline", duration = 1.5, description = "Blocks slide by the law, or stick." }
local g, angle = 9.81, math.pi / 9
local c, s = math.cos(angle), math.sin(angle)
body { name = "ramp", type = "static", box { 40, 1, at = {0, -0.5} }, angle = angle, material = material { friction = 1 } }
for i, case in ipairs { {"free", 0}, {"slow", 0.3}, {"near", 0.35}, {"stuck", 0.37}, {"no turning", 0.37} } do
    local name, mu = case[1], case[2]
    local along = 3 * i - 8
    local x, y = c * along - s * 0.25, s * along + c * 0.25
    body { name = name, box { 0.5, 0.5 }, at = {x, y}, angle = angle, material = material { friction = mu * mu }, sleep = false,
           fixed_rotation = name == "no turning" }
    local a = math.max(0, g * (s - mu * c))
    exact { name, measure = function()
        local px, py = find(name):position()
        return along - (c * px + s * py)
    end, value = function(t) return a * t * t / 2 end, unit = "m" }
end
expect { "without friction", exact = "free", tolerance = 4.4e-05 }
expect { "mu = 0.3", exact = "slow", tolerance = 0.0014 }
expect { "mu = 0.35", exact = "near", tolerance = 0.0038 }
expect { "mu = 0.37 sticks", exact = "stuck", tolerance = 0.00018 }
expect { "mu = 0.37 sticks that cannot turn", exact = "no turning", tolerance = 1.6e-06 }
