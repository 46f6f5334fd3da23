-- pixel_imperfect.lua - bricks fall into shafts of bricks: one with 2 mm to spare, one with 20 um, and one that is exactly
-- as wide as its shaft. Without friction nothing may catch on edges or seams: all fall freely.
scene { title = "Pixel imperfect", duration = 1 }
camera { fit = {{-3, -5}, {17, 9}}, at = 0.75, trail = 0.5 }
local ice = material { friction = 0 }
for k, gap in ipairs { 0.001, 0.00001, 0 } do -- on either side
    local x, name = 7 * (k - 1), "brick" .. k
    for i = 0, 9 do
        body { type = "static", material = ice, box { 1, 1, at = {x - 1.5, i - 4.5} }, box { 1, 1, at = {x + 1.5, i - 4.5} } }
    end
    body { name = name, box { 2 - 2 * gap, 1 }, at = {x, 7}, fixed_rotation = true, material = ice, color = k }
    exact { name, body = name, x = function() return x end, y = function(t) return 7 - 4.905 * t * t end }
    expect { ("with %g m to spare it falls freely"):format(gap), exact = name, tolerance = 2e-3 }
    expect { ("with %g m to spare it goes in"):format(gap), body = name, y = {1, 5.3} }
end
