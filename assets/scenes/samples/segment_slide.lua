-- segment_slide.lua - discs of 2 cm to 1 m roll down a slope made of one line, over the kink at its foot and up against a
-- line for a wall. Lines have no thickness; nobody falls through or sticks in the corner.
-- A disc that rolls without slipping has v^2 = 4 g h / 3 after a fall of h.
scene { title = "Segment slide", duration = 6 }
camera { fit = {{-12, -2}, {14, 8}}, at = 1.9, trail = 1.5 }
local rough = material { friction = 1 }
body { type = "static", material = rough, segment { {-40, 0}, {20, 0} }, segment { {-12, 6}, {0, 0} }, segment { {12, 0}, {12, 6} } }
local slope = math.atan(6, 12)
for k, r in ipairs { 0.02, 0.1, 0.5 } do
    local x, y = -11 + 2.2 * (k - 1), 0
    y = -x / 2
    body { name = "disc" .. k, circle { r }, at = {x + r * math.sin(slope), y + r * math.cos(slope)}, material = rough, color = k,
           ignores = "disc", category = "disc" }
    expect { ("disc %d is never below the lines"):format(k), always = true, body = "disc" .. k, y = {0.9 * r, 7}, x = {-12, 12} }
    local a, s = 9.81 * math.sin(slope) * 2 / 3, 1 -- after t: a t^2 / 2 along the slope
    expect { ("disc %d rolls with 2/3 g sin"):format(k), at = s, body = "disc" .. k, tolerance = 0.03,
             position = {x + r * math.sin(slope) + a / 2 * math.cos(slope), y + r * math.cos(slope) - a / 2 * math.sin(slope)} }
end
