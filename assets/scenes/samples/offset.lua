-- offset.lua - shapes that lie far from the frame of their body: thrown, it is the centre of mass that flies the parabola, and
-- the body turns about it.
scene { title = "Offset shapes", duration = 2 }
camera { fit = {{-3, -9}, {15, 6}}, at = 1, trail = 1 }
for k, d in ipairs { 0, 1, 4 } do
    local name, w = "thing" .. k, 3
    local it = body { name = name, box { 1, 0.5, at = {d, 0} }, circle { 0.25, at = {d, 0} }, at = {-d, 2 * k}, velocity = {5, 3}, spin = w, color = k, apart = "things" }
    local cx, cy = it:center()
    exact { name, body = name, x = function(t) return cx + 5 * t - d * math.cos(w * t) end,
            y = function(t) return cy + 3 * t - 4.905 * t * t - d * math.sin(w * t) end }
    expect { ("an offset of %g m: its centre flies the parabola"):format(d), always = true, exact = name, tolerance = 2e-3 }
end
