-- degenerate_needles.lua - 30 needles of 1 m by 2 mm and slivers with corners of a degree fall into a bin.
-- Fails: normals of slivers that flip, needles through the floor (Avian and Godot tell of it). Right: a heap inside.
-- lint: allow size: thin things are what it asks
-- watchdog: allow sinking, tunnelling: needles of 2 mm go through one another
scene { title = "Needles and slivers", duration = 8, seed = 9 }
local n = param("n", 30, 1, 300)
local steel = material { density = 7800, friction = 0.3 }
body { type = "static", material = steel, box { 4, 1, at = {0, -0.5} },
       box { 1, 60, at = {-1.5, 29} }, box { 1, 60, at = {1.5, 29} } }
local things, was, fastest, worst = {}, {}, 0, 0
for i = 1, n do
    local shape = i % 2 == 0 and box { 1, 0.002 } or polygon {{-0.4, 0}, {0.4, -0.007}, {0.4, 0.007}}
    things[i] = body { name = "thing" .. i, shape, material = steel,
                       at = {random(-0.4, 0.4), 0.3 + i * 0.55}, angle = random(-0.5, 0.5) }
end
every_step(function()
    fastest = 0
    for i, b in ipairs(things) do
        local x, y = b:position()
        if was[i] then fastest = math.max(fastest, math.abs(x - was[i][1]) * 60, math.abs(y - was[i][2]) * 60) end
        was[i] = {x, y}
    end
    worst = math.max(worst, fastest)
end)
expect { "all are in the bin", always = true, body = "thing*", x = {-1.05, 1.05}, y = {-0.05, 0.6 + n * 0.55} }
expect { "nothing is faster than its fall", test = function()
    local limit = 1.1 * math.sqrt(2 * 9.81 * (0.3 + n * 0.55))
    return worst <= limit, worst, limit
end }
expect { "the heap comes to rest", from = 7, test = function() return fastest <= 0.02, fastest, 0.02 end }
