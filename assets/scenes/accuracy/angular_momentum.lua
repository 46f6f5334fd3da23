-- angular_momentum.lua - five hinged links tumble in free space: momentum, angular momentum and energy stay.
-- Source: Noether 1918. Hard: joints that correct places after velocities leak angular momentum.
-- Aim: 1e-4 (energy 1e-3).
scene { title = "Tumbling chain", gravity = {0, 0}, duration = 10, description = "A free chain keeps its angular momentum." }
local links = {}
for i = 1, 5 do
    links[i] = body { name = "link" .. i, box { 1, 0.1 }, at = {i - 3, 0}, velocity = {0, (i - 3) * 2},
            spin = 2 + (i == 5 and 6 or 0),
                      mass = 1, apart = "all", sleep = false }
    if i > 1 then revolute { links[i - 1], links[i], at = {i - 3.5, 0} } end
end
local function angular()
    local sum = 0
    for _, b in ipairs(links) do
        local x, y = b:center()
        local vx, vy = b:velocity()
        sum = sum + b:mass() * (x * vy - y * vx) + b:inertia() * b:spin()
    end
    return sum
end
local l0, e0
every_step(function(t) if t > 0.1 and not l0 then l0, e0 = angular(), energy() end end)
exact { "angular momentum", from = 0.2, measure = function() return angular() / l0 end, value = function() return 1 end }
exact { "energy", from = 0.2, measure = function() return energy() / e0 end, value = function() return 1 end }
exact { "momentum", unit = "N s", measure = function() local x, y = momentum() return math.sqrt(x * x + y * y) end,
        value = function() return 0 end }
expect { "the angular momentum", exact = "angular momentum", tolerance = 8e-06 }
expect { "the energy", exact = "energy", tolerance = 0.00058 }
expect { "the momentum", exact = "momentum", tolerance = 9.4e-05 }
