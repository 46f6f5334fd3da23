-- compasses.lua - needles on pins round a magnet that turns for a while. Shows: dipole, of a needle and of a bar magnet alike, in a
-- mutual{} law on charge; the field of a dipole, twice as strong ahead of it as beside it; needles that fall asleep when it stands.
scene { title = "Compasses round a magnet that turns", gravity = {0, 0}, duration = 20, dt = 1 / 60,
        description = "The magnet turns once and a third round and stops; the needles follow, and sleep." }
camera { fit = {{-4.6, -2.6}, {4.6, 2.6}}, at = 7 }
local k, moment = 1, param("moment", 200, 20, 500)
mutual { strength = k, on = "charge", softening = 0.1 }

local magnet = body { name = "magnet", box { 1.2, 0.4 }, dipole = moment, density = 60, color = "#cfd3d8" }
local axle = revolute { magnet, world, motor = { speed = 1, torque = 4000 } }

-- Needles of brass, so weak that they hardly turn one another.
local needles = {}
for i = -4, 4 do
    for j = -2, 2 do
        if math.abs(i) > 1 or math.abs(j) > 1 then
            local n = body { name = "needle" .. i .. "_" .. j, at = {i, j}, angle = 0.3 * i + 0.5 * j, density = 10,
                             polygon { {0.36, 0}, {0, 0.09}, {-0.36, 0}, {0, -0.09} }, color = "#b08d3c",
                             dipole = 0.02, angular_damping = 4 }
            revolute { n, world, at = {i, j} }
            needles[#needles + 1] = n
        end
    end
end
at(8.4, function() axle:set_motor(0, 4000) end)

-- The field of a dipole along u at a way d: (3 (u . d) d - d^2 u) / d^5.
local function off(n)
    local x, y = n:position()
    local mx, my = magnet:position()
    local a, dx, dy = magnet:angle(), x - mx, y - my
    local ux, uy = math.cos(a), math.sin(a)
    local along, square = ux * dx + uy * dy, dx * dx + dy * dy
    local ex, ey = 3 * along * dx - square * ux, 3 * along * dy - square * uy
    local turn = n:angle() - math.atan(ey, ex)
    return math.abs(math.atan(math.sin(turn), math.cos(turn)))
end
expect { "all point along the field", at = 20, test = function()
    local most = 0
    for _, n in ipairs(needles) do most = math.max(most, off(n)) end
    return most < 0.1, most, 0.1
end }
expect { "and sleep", at = 20, test = function()
    local awake = 0
    for _, n in ipairs(needles) do awake = awake + (n:awake() and 1 or 0) end
    return awake == 0, awake, 0
end }
