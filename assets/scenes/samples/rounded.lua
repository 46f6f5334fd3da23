-- rounded.lua - boxes, polygons and ellipses with round edges fall into a bin, and come to rest in a heap; a rounded box
-- stands on its flat side at half its height, radius and all, and an ellipse rolls to its flat side.
scene { title = "Rounded and elliptic shapes", duration = 10, seed = 5 }
camera { fit = {{-9, -1}, {11, 9}}, at = 10 }
local stuff = material { friction = 0.5, rolling_resistance = 0.005 }
body { type = "static", box { 40, 1, at = {0, -0.5} }, box { 0.5, 6, at = {-6, 3} }, box { 0.5, 6, at = {3, 3} }, material = stuff }
local function ellipse(a, b)
    local points = {}
    for i = 0, 15 do points[#points + 1] = { a * math.cos(i * math.pi / 8), b * math.sin(i * math.pi / 8) } end
    return polygon(points)
end
for i = 1, 24 do
    local shape = i % 3 == 0 and box { random(0.3, 0.8), random(0.3, 0.8), round = random(0.05, 0.3) } or
                  i % 3 == 1 and regular(3 + i % 5, random(0.3, 0.5)) or ellipse(random(0.4, 0.7), random(0.2, 0.35))
    body { name = "heap" .. i, shape, at = {-4.5 + 1.5 * (i % 5), 1 + 1.5 * (i // 5)}, angle = random(0, 6), material = stuff, color = i % 3 + 1 }
end
body { name = "standing", box { 1, 0.6, round = 0.2 }, at = {6, 0.7}, material = stuff, color = 4 }
body { name = "egg", ellipse(1, 0.5), at = {9, 1.05}, angle = 1.3, material = stuff, color = 5 }
expect { "the heap stays in its bin", always = true, body = "heap*", x = {-5.75, 2.75}, y = {0, 9} }
expect { "it comes to rest", body = "heap*", max_speed = 0.05 }
expect { "a rounded box stands at h / 2 + r", from = 2, body = "standing", y = 0.5, tolerance = 0.005 }
expect { "the egg lies on its flat side", test = function()
    local tip = math.abs(math.sin(find("egg"):angle())) return tip < 0.25, tip, 0.25
end }
expect { "nothing sinks", max_penetration = 0.01 }
