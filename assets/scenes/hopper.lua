-- hopper.lua - mixed shapes run through a funnel into a bin.
-- Shows: circles, boxes, capsules, polygons and compounds of sizes 1:4 in one crowd.
scene { title = "Hopper", description = "Mixed shapes pour through a funnel.", duration = 20, seed = 5 }
camera { fit = {{-7, -1}, {7, 16.5}}, at = 1.7 }

local steel = material { name = "steel", friction = 0.3 }
local grain = material { name = "grain", density = 800, friction = 0.3, restitution = 0.1 }
-- The bin, the funnel above it and the walls on the funnel's shoulders are one body.
body { name = "hopper", type = "static", material = steel, color = "#4a5568",
       box { 14, 1, at = {0, -0.5} }, box { 1, 5, at = {-6.5, 2.5} }, box { 1, 5, at = {6.5, 2.5} },
       polygon {{-7, 12}, {-7, 5}, {-2.0, 5}, {-1.8, 6.8}, {-6.5, 12}},
       polygon {{7, 12}, {6.5, 12}, {1.8, 6.8}, {2.0, 5}, {7, 5}},
       box { 0.5, 3, at = {-6.75, 13.5} }, box { 0.5, 3, at = {6.75, 13.5} } }

local makers = {
    function(size) return { circle { size / 2 } } end,
    function(size) return { box { size, size * random(0.5, 1) } } end,
    function(size) return { capsule { size * 0.6, size * 0.25 } } end,
    function(size) return { regular { random_int(3, 7), size * 0.55 } } end,
    function(size) return { box { size, size * 0.3 }, box { size * 0.3, size } } end, -- a cross
}
local count = param("count", 105, 1, 1000)
for i = 1, count do
    local kind = (i - 1) % #makers + 1
    local shapes = makers[kind](random(0.2, 0.8))
    shapes.name = "grain" .. i
    shapes.at = {((i - 1) % 7 - 3) * 1.15, 10.5 + ((i - 1) // 7) * 1.15}
    shapes.angle = random(0, 6)
    shapes.material = grain
    shapes.color = kind
    body(shapes)
end

expect { "nothing is lost", at = 20, body = "grain*", x = {-6, 6}, y = {0, 14} }
expect { "nearly all has passed the funnel", at = 20, test = function()
    local below = 0
    for i = 1, count do
        local _, y = find("grain" .. i):position()
        if y < 5 then below = below + 1 end
    end
    return below >= 0.9 * count, below, 0.9 * count
end }
expect { "the heap lies still", at = 20, max_speed = 1 }
expect { "little overlap", at = 20, max_penetration = 0.03 }
