-- wedge.lua - a disc is shot at 60 m/s, 1 m a step, into the corner of two lines that meet at 30 degrees. It is caught by
-- both, at the distance r / sin 15 from the corner, and lies there.
scene { title = "Wedge", duration = 3 }
camera { fit = {{-5, -0.5}, {8, 9}}, at = 0.1, trail = 0.2 }
local half = radians(15)
for k, r in ipairs { 0.1, 0.3, 0.6 } do
    local x = 4 * (k - 1) - 3
    body { type = "static", segment { {x, 0}, {x - 8 * math.sin(half), 8 * math.cos(half)} },
           segment { {x, 0}, {x + 8 * math.sin(half), 8 * math.cos(half)} } }
    body { name = "disc" .. k, circle { r }, at = {x, 7.5}, velocity = {0, -60}, color = k, apart = "discs" }
    local rest = r / math.sin(half)
    expect { ("disc %d never leaves the wedge"):format(k), always = true, body = "disc" .. k, y = {0.8 * rest, 8.5}, x = {x - 2.1, x + 2.1} }
    expect { ("disc %d lies at r / sin"):format(k), body = "disc" .. k, position = {x, rest}, tolerance = 0.03 * rest }
end
