-- rolling_resistance.lua - discs roll at 5 m/s on floors of growing rolling resistance. The arm d of the normal force brakes
-- rolling by d g / r over 1 + I / (m r^2) = 3/2: they stop after v^2 / (2 a); without it they roll on.
scene { title = "Rolling resistance", duration = 10 }
camera { fit = {{-4, -1}, {54, 12}}, at = 10, trail = 10 }
local r, v = 0.5, 5
for k = 0, 5 do
    local d, y, name = 0.01 * k * k, 2 * k, "disc" .. k
    body { type = "static", segment { {-3, y}, {60, y} }, color = "#8792a2" }
    body { name = name, circle { r }, at = {-2, y + r}, velocity = {v, 0}, spin = -v / r, color = k + 1, label = ("%g"):format(d),
           material = material { rolling_resistance = d, friction = 1 } }
    local a = d * 9.81 / r / 1.5
    local way = d > 0 and math.min(v * v / (2 * a), v * 10) or v * 10
    if d > 0 and v / a > 10 then way = v * 10 - a * 50 end
    expect { ("d = %g m: it rolls %.4g m"):format(d, way), body = name, x = -2 + way, tolerance = 0.02 * way }
    expect { ("d = %g m: it rolls without slipping"):format(d), always = true, test = function()
        local b = find(name)
        local vx = b:velocity()
        return math.abs(vx + b:spin() * r) < 0.02, vx + b:spin() * r, 0
    end }
end
