-- sensor_funnel.lua - discs and capsules fall through a zigzag of slides; a sensor at the bottom takes each out of the
-- world when it comes. A hundred and twenty go in at the top, and all of them are counted out.
scene { title = "Sensor funnel", duration = 20, seed = 6 }
camera { fit = {{-8, -7}, {8, 13}}, at = 6 }
local steel = material { friction = 0.1 }
body { type = "static", material = steel, chain { {-6, 12}, {-6, 2}, {-1.2, -4}, {-1.2, -6} }, chain { {6, 12}, {6, 2}, {1.2, -4}, {1.2, -6} } }
for i = 0, 1 do
    local side = i == 0 and -1 or 1
    body { type = "static", material = steel, box { 6.5, 0.2 }, at = {side * 3, 6.5 - 2.6 * i}, angle = side * 0.45, color = "#8792a2" }
end
local out = body { name = "out", type = "static", sensor = true, box { 3, 1 }, at = {0, -6.2}, color = "#cf6e73" }
local made, n = 0, 120
every(0.1, function()
    if made < n then
        made = made + 1
        local it = made % 2 == 0 and circle { 0.22 } or capsule { 0.3, 0.15 }
        body { name = "thing" .. made, it, at = {random(-4, 4), 11.5}, angle = random(0, 3), material = steel, color = made % 5 + 1 }
    end
end)
score("out", 0)
on_enter { a = out, b = "thing*", function(_, it) score("out", score("out") + 1) it:destroy() end }
expect { "all are counted out", score = "out", value = {n, n} }
expect { "nobody is left", body = "thing*", count = 0 }
expect { "nobody falls through the funnel", always = true, test = function()
    local b = nearest { at = {0, -12}, within = 4 } return b == nil, b and 1 or 0, 0
end }
