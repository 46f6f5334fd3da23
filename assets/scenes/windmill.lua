-- windmill.lua - wind turns a rotor of two half pipes (Savonius, 1926), seen from above, and has less speed behind it.
-- Shows: air{} that drives a body and is slowed by it, a generator that brakes it, smoke in the wake, power from the wind.
scene { title = "Windmill", dt = 1 / 30, duration = 10, gravity = {0, 0},
        description = "A rotor of 2 m in a wind of 4 m/s; the generator takes a torque in proportion to its speed." }
camera { fit = {{-3.3, -2.6}, {6.4, 2.6}}, at = 9.5 }
local wind, brake = param("wind", 4, 0.5, 8), param("brake", 1, 0, 20)
air { size = {9.6, 5.6}, at = {1.6, 0}, cell = param("cell", 0.1, 0.03, 0.13),
      left = "flow", top = "flow", bottom = "flow", flow = {wind, 0}, fading = 0.05 }

-- Half a pipe of radius r about (x, y), its hollow to the left if side is 1.
local function bucket(x, y, r, thick, side)
    local points = {}
    for i = 0, 12 do
        local a = side * (math.pi / 2) - math.pi * i / 12 * side
        points[#points + 1] = {x + side * r * math.cos(a), y + r * math.sin(a)}
    end
    for i = 12, 0, -1 do
        local a = side * (math.pi / 2) - math.pi * i / 12 * side
        points[#points + 1] = {x + side * (r - thick) * math.cos(a), y + (r - thick) * math.sin(a)}
    end
    return outline(points)
end

local rotor = body { name = "rotor", density = 12, color = 2, angle = 0.6,
                     bucket(0, 0.42, 0.55, 0.13, 1), bucket(0, -0.42, 0.55, 0.13, -1) }
revolute { "rotor", world, at = {0, 0} }
for i = -3, 3 do air_source { at = {-2.8, 0.55 * i}, radius = 0.14, smoke = 22 } end

local work, since = 0, 0
every_step(function(t, dt)
    local w = rotor:spin()
    rotor:apply_torque(-brake * w)
    if t > 5 then work, since = work + brake * w * w / 30, since + 1 / 30 end
end)

-- Savonius rotors have power coefficients of 0.1 to 0.25 of the wind's 1/2 rho v^3 times their width of 1.94 m.
expect { "it takes power from the wind", at = 10, test = function()
    local share = work / since / (0.5 * 1.2 * wind * wind * wind * 1.94)
    return share > 0.05 and share < 0.35, share, 0.35
end }
expect { "less wind is left behind it", at = 10, test = function()
    local sum = 0
    for y = -1, 1, 0.1 do sum = sum + (air_at(2.5, y)) / 21 end
    return sum < 0.9 * wind, sum, 0.9 * wind
end }
