-- chain_slide.lua - a disc, a box and a capsule slide at 30 m/s without friction along a chain of thirty flat pieces, each
-- a metre long. The seams between them are not felt: speed and height stay as they are.
scene { title = "Chain slide", duration = 1 }
camera { fit = {{-16, -2}, {17, 7}}, at = 0.5, trail = 0.3 }
local ice = material { friction = 0 }
for k, thing in ipairs { circle { 0.4 }, box { 0.8, 0.8 }, capsule { 0.6, 0.4 } } do
    local y, points = 2 * (k - 1), {}
    for i = 0, 30 do points[#points + 1] = { -15 + i, y } end
    body { type = "static", material = ice, chain(points) }
    body { name = "thing" .. k, thing, at = {-14, y + 0.4}, velocity = {28, 0}, material = ice, color = k }
    expect { ("thing %d keeps its height"):format(k), always = true, body = "thing" .. k, y = y + 0.4, tolerance = 2e-3 }
    expect { ("thing %d does not turn"):format(k), always = true, body = "thing" .. k, spin = 0, tolerance = 1e-3 }
    expect { ("thing %d keeps its speed"):format(k), body = "thing" .. k, vx = 28, x = 14, tolerance = 0.01 }
end
