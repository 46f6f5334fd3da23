-- friction.lua - boxes with coefficients 0.75 to 0 on a ramp of 14 degrees whose own is 0.2: a pair has the root of the product.
-- Those with a root above tan 14 = 0.25 stay; the others slide by g (sin - mu cos) and fall onto the ramp below.
scene { title = "Friction", duration = 3 }
camera { fit = {{-16, -1}, {16, 12}}, at = 1.2, trail = 1.2 }
local s, own = math.atan(0.25, 1), 0.2
local ramp = material { friction = own }
body { type = "static", material = ramp, polygon { {-15, 10}, {15, 2.5}, {15, 2.2}, {-15, 9.7} } }
body { type = "static", box { 60, 1 }, at = {0, -0.5} }
for k, mu in ipairs { 0.75, 0.5, 0.35, 0.1, 0 } do
    local along = 4 * k -- from the upper end
    local x = -15 + along * math.cos(s) + 0.5 * math.sin(s)
    local y = 10 - along * math.sin(s) + 0.5 * math.cos(s)
    local name = "box" .. k
    body { name = name, box { 1, 1 }, at = {x, y}, angle = -s, material = material { friction = mu }, color = k, apart = "boxes" }
    local pair = math.sqrt(mu * own)
    local a = math.max(0, 9.81 * (math.sin(s) - pair * math.cos(s)))
    expect { ("mu = %.2f: after 1 s it is at a / 2"):format(pair), at = 1, body = name, tolerance = 0.02,
             position = {x + a / 2 * math.cos(s), y - a / 2 * math.sin(s)} }
end
expect { "the rough ones stay", from = 1, body = "box1", max_speed = 0.001 }
