-- box_restitution.lua - boxes that fall flat, with e = 0 to 1, from 4 m: each rises to e^2 h, without turning, though it lands
-- on two corners at once.
scene { title = "Box restitution", duration = 1.7 }
camera { fit = {{-1, -1}, {16, 6}}, at = 1.6, trail = 0.7 }
local h = 4
for k = 0, 10 do
    local e, name = k / 10, "box" .. k
    body { type = "static", segment { {1.5 * k - 0.7, 0}, {1.5 * k + 0.7, 0} } }
    body { name = name, box { 0.8, 0.4 }, at = {1.5 * k, h + 0.2}, material = material { restitution = e }, color = k + 1 }
    -- The speed after the blow: e sqrt(2 g h), at t = sqrt(2 h / g).
    local t0 = math.sqrt(2 * h / 9.81)
    if k >= 2 then
        local v = e * math.sqrt(2 * 9.81 * h)
        expect { ("e = %g: it comes back by it"):format(e), at = 1.2, body = name, tolerance = 0.03,
                 y = 0.2 + v * (1.2 - t0) - 4.905 * (1.2 - t0) * (1.2 - t0) }
    end
    expect { ("e = %g: it does not turn"):format(e), always = true, body = name, angle = 0, tolerance = 1e-3 }
end
expect { "e = 0 stays down", at = 1.2, body = "box0", y = 0.2, tolerance = 0.005 }
