-- incline_roll.lua - discs on an incline of 30 degrees roll while tan <= 3 mu: a = 2 g sin / 3; else a = g (sin - mu cos)
-- and they spin up by 2 mu g cos / r.
-- Source: any textbook of mechanics. Hard: the threshold lies at mu = 0.1925.
-- Aim: 1e-3 m.
scene { title = "Rolling down", duration = 1.5, description = "Discs roll, or slip, down an incline." }
local g, angle, r = 9.81, math.pi / 6, 0.4
local c, s = math.cos(angle), math.sin(angle)
body { name = "ramp", type = "static", box { 60, 1, at = {0, -0.5} }, angle = angle, material = material { friction = 1 } }
for i, case in ipairs { {"rolls", 0.3}, {"just rolls", 0.2}, {"slips", 0.1} } do
    local name, mu = case[1], case[2]
    local along = 4 * i
    local disc = body { name = name, circle { r }, at = {c * along - s * r, s * along + c * r},
            material = material { friction = mu * mu } }
    local rolls = math.tan(angle) <= 3 * mu
    local a = rolls and 2 * g * s / 3 or g * (s - mu * c)
    local spin = rolls and a / r or 2 * mu * g * c / r
    exact { name, measure = function()
        local x, y = disc:position()
        return along - (c * x + s * y)
    end, value = function(t) return a * t * t / 2 end, unit = "m" }
    exact { name .. ", spin", body = name, spin = function(t) return spin * t end }
end
expect { "rolling", exact = "rolls", tolerance = 4.3e-05 }
expect { "just rolling", exact = "just rolls", tolerance = 4.4e-05 }
expect { "slipping", exact = "slips", tolerance = 6e-05 }
expect { "rolling, spin", exact = "rolls, spin", tolerance = 2.6e-05 }
expect { "slipping, spin", exact = "slips, spin", tolerance = 1.9e-05 }
