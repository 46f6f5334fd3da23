-- wind.lua - leaves that a gusty wind blows over a house with a vane, and a pennant.
-- Shows: wind, gusts, a layer near the ground where it is weaker, drag surface by surface.
scene { title = "Wind", description = "Leaves flutter, a vane turns, a pennant streams: by the pressure on each side of each.", duration = 12,
        seed = 4 }
camera { fit = {{-10, -0.6}, {14, 9}}, at = 4.1, trail = 0.5 }
body { type = "static", segment { {-40, 0}, {40, 0} }, name = "ground" }
local air = wind { category = "air", box { 200, 40 }, at = {0, 20}, flow = {6, 0}, gust = 0.25, gust_length = 20, shear_height = 1.5 }

-- A vane on a house: it turns its broad end away from the wind.
local house = body { type = "static", polygon { {5, 0}, {9, 0}, {9, 2.2}, {5, 2.2} }, polygon { {4.7, 2.2}, {9.3, 2.2}, {7, 3.8} }, box { 0.1, 1.4, at = {7, 4.3} } }
local vane = body { name = "vane", gravity_scale = 0, at = {7, 5}, angle = 2.5, density = 10, category = "vane", collides = "air", color = 1,
                    polygon { {-1.1, -0.05}, {1.5, -0.05}, {1.5, 0.05}, {-1.1, 0.05} }, polygon { {-1.2, 0}, {-0.8, -0.22}, {-0.8, 0.22} },
                    polygon { {0.9, -0.05}, {1.7, -0.5}, {1.7, 0.5}, {0.9, 0.05} } }
revolute { vane, at = {7, 5}, motor = { speed = 0, torque = 4 }, hidden = true }

-- A pennant of eight links.
body { type = "static", box { 0.12, 5 }, at = {-6, 2.5}, collides = {}, name = "mast" }
local last, links = find("mast"), {}
for i = 1, 8 do
    local link = body { name = "link" .. i, box { 0.42, 0.06 + 0.04 * (8 - i) }, density = 3, at = {-5.73 + 0.42 * (i - 1), 4.7}, collides = "air", color = 3 }
    revolute { last, link, at = {-5.94 + 0.42 * (i - 1), 4.7}, hidden = true }
    last, links[i] = link, link
end

local leaves = {}
for i = 1, 40 do
    leaves[i] = body { name = "leaf" .. i, polygon { {-0.14, 0}, {0, -0.035}, {0.14, 0}, {0, 0.035} }, density = 4,
                       at = {random(-10, -2), random(1.5, 8.5)}, angle = random(0, 6), color = i % 3 == 0 and "#d98a2b" or i % 3 == 1 and "#b5452c" or "#8aa33b",
                       ignores = "leaf", category = "leaf" }
end

expect { "the vane points into the wind", at = 8, test = function()
    local a = math.abs(math.atan(math.sin(vane:angle()), math.cos(vane:angle()))) return a < 0.3, a, 0.3
end }
expect { "leaves are carried along", at = 4, test = function()
    local far = 0
    for _, leaf in ipairs(leaves) do far = far + leaf:position() / #leaves end
    return far > 3, far, 3
end }
expect { "none is faster than the strongest gust", always = true, test = function()
    local most = 0
    for _, leaf in ipairs(leaves) do local x = leaf:velocity() most = math.max(most, x) end
    return most < 12, most, 12
end }
expect { "the pennant streams", at = 10, test = function() local x, y = links[8]:position() return x > -3.8 and y > 3.2, x, -3.8 end }
