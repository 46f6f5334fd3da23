-- tangent_speed.lua - a chain whose surface runs accelerates what lies on it: discs, heavy against rolling, come onto a belt of
-- 8 m/s piece after piece and leave it at that speed; boxes on a belt of 2 m/s have it after v / (mu g).
scene { title = "Surfaces that run", duration = 7.5 }
camera { fit = {{-13, -1.5}, {19, 6}}, at = 2.6, trail = 1 }
local belts = {}
for i = 1, 3 do belts[i] = material { friction = 0.6, surface_speed = ({ 2, 4, 8 })[i] } end
for i = 1, 3 do body { name = "belt" .. i, type = "static", material = belts[i], chain { {-12 + 8 * (i - 1), 0}, {-4 + 8 * (i - 1), 0} }, color = "#718096" } end
body { type = "static", chain { {12, 0}, {60, 0}, {60, 3} } }
body { name = "upper", type = "static", material = belts[1], box { 14, 0.3 }, at = {-4, 3.85}, color = "#718096" }
local crate = body { name = "crate", box { 0.8, 0.8 }, at = {-11.4, 0.4}, material = material { friction = 0.6 }, color = 1 }
for i = 1, 3 do body { name = "box" .. i, box { 0.6, 0.6 }, at = {-10 + 1.5 * i, 4.3}, material = material { friction = 0.6 }, color = 2 } end
local t1 = 2 / (0.6 * 9.81)
local seen = {}
every_step(function(t)
    local x = crate:position()
    for i = 1, 3 do if x < -4.6 + 8 * (i - 1) and x > -5.6 + 8 * (i - 1) then seen[i] = (crate:velocity()) end end
end)
expect { "boxes have the belt's speed after v / (mu g)", at = t1 + 0.05, body = "box*", vx = 2, tolerance = 0.01 }
expect { "and are half way then", at = t1 + 0.05, body = "box1", x = -8.5 + t1 + 0.1, tolerance = 0.03 }
expect { "half of it before", at = t1 / 2, body = "box*", vx = 1, tolerance = 0.12 }
expect { "the crate has each belt's speed at its end", test = function()
    local off = math.max(math.abs((seen[1] or 0) - 2), math.abs((seen[2] or 0) - 4), math.abs((seen[3] or 0) - 8))
    return off < 0.05, off, 0.05
end }
expect { "it never leaves the belt", always = true, body = "crate", y = {0.39, 0.41} }
