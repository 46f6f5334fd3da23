-- fruit_bowl.lua - fruit falls into a concave bowl and stays there.
-- Shows: a concave outline, split exactly into convex pieces of one body; round, capsule and polygon fruit.
scene { title = "Bowl of fruit", description = "A concave bowl holds what falls into it.", duration = 8, seed = 12 }
camera { fit = {{-3.6, -0.5}, {3.6, 4.6}} }

local table_top = material { name = "table", friction = 0.7 }
local china = material { name = "china", density = 2400, friction = 0.4, restitution = 0.1 }
local peel = material { name = "peel", density = 950, friction = 0.5, restitution = 0.2 }

body { name = "table", type = "static", box { 12, 0.5 }, at = {0, -0.25}, material = table_top, color = "#8d6e4f" }

-- The bowl: an arc outside, a smaller one inside, walked around once.
local points = {}
local steps, outer, inner, center = 14, 2.3, 2.1, 2.3
for i = 0, steps do
    local a = math.pi * (1 + i / steps)
    points[#points + 1] = { outer * math.cos(a), math.max(0, center + outer * math.sin(a)) }
end
for i = steps, 0, -1 do
    local a = math.pi * (1 + i / steps)
    points[#points + 1] = { inner * math.cos(a), center + inner * math.sin(a) }
end
body {
    name = "bowl", outline(points), box { 1.6, 0.12, at = {0, 0.06} }, at = {0, 0.002}, material = china,
    color = "#5b8fb9",
}

for i = 1, 7 do -- oranges
    body { name = "orange" .. i, circle { random(0.22, 0.28) }, at = {random(-1.1, 1.1), 2.2 + 0.55 * i},
           material = peel, color = "#f08a24" }
end
for i = 1, 4 do -- bananas: two capsules at an angle
    body {
        name = "banana" .. i, capsule { 0.45, 0.1, at = {-0.2, 0}, angle_deg = 20 },
        capsule { 0.45, 0.1, at = {0.2, 0}, angle_deg = -20 }, at = {random(-1, 1), 6 + 0.7 * i},
        angle = random(-1, 1), material = peel, color = "#f2c230",
    }
end
for i = 1, 5 do -- plums, with corners rounded
    body { name = "plum" .. i, regular { 6, 0.12, round = 0.08 }, at = {random(-1, 1), 9 + 0.5 * i},
           material = peel, color = "#7b3f83" }
end

local fruit = { "orange*", "banana*", "plum*" }
for _, kind in ipairs(fruit) do
    expect { kind .. " are in the bowl", at = 8, body = kind, x = {-2.3, 2.3}, y = {0.1, 3.5} }
    expect { kind .. " lie still", at = 8, body = kind, max_speed = 0.2 }
end
expect { "the bowl stands", at = 8, body = "bowl", x = 0, y = 0, tolerance = 0.1 }
expect { "little overlap at rest", at = 8, max_penetration = 0.01 }
