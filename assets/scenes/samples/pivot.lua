-- pivot.lua - four free rods are struck at 0, 1/6, 1/3 and 1/2 of their length from the middle. Struck at 1/6, the centre
-- of percussion, a rod begins to turn about its other end, which stays where it is.
-- v = J / m, w = J d / I with I = m L^2 / 12: the other end has v - w L / 2.
scene { title = "Pivot", gravity = {0, 0}, duration = 2 }
camera { fit = {{-2.5, -2.5}, {15, 4}}, at = 0.35, trail = 0.35 }
local L, m, J = 2, 3, 6
for k, share in ipairs { 0, 1 / 6, 1 / 3, 1 / 2 } do
    local x, d = 4 * (k - 1), share * L
    local rod = body { name = "rod" .. k, box { 0.1, L }, at = {x, 0}, mass = m, inertia = m * L * L / 12, color = k }
    local v, w = J / m, -J * d / (m * L * L / 12) -- struck to the right above the middle, it turns clockwise
    at(0, function() rod:apply_impulse(J, 0, x, d) end)
    exact { ("rod %d"):format(k), body = "rod" .. k, x = function(t) return x + v * t end, y = function() return 0 end }
    expect { ("rod %d keeps to v t"):format(k), exact = ("rod %d"):format(k), tolerance = 1e-4 }
    expect { ("rod %d turns at J d / I"):format(k), always = true, body = "rod" .. k, spin = w, tolerance = 1e-3 }
    local function lower_end() -- speed of the end that was not struck
        local vx, vy = rod:velocity()
        local a = rod:angle()
        return vx + rod:spin() * L / 2 * math.cos(a), vy + rod:spin() * L / 2 * math.sin(a)
    end
    expect { ("the other end of rod %d starts at v - w L / 2"):format(k), at = 0, test = function()
        local u = lower_end()
        local off = math.abs(u - (v + w * L / 2))
        return off < 0.04, u, v + w * L / 2
    end }
end
