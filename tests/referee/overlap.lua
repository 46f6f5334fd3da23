-- overlap.lua - four rows of crates that begin inside one another by `share` of their size: the fastest that anything moves,
-- from the differences of its places. Right: it opens at some metres a second at most.
-- lint: allow overlap: it begins so on purpose
scene { title = "Overlap", duration = 4, sleep = false }
local share, rows = param("share", 0.25, 0, 0.9), 4
local wood = material { density = 600, friction = 0.6 }
body { type = "static", box { 40, 1 }, at = {0, -0.5}, material = wood }
local boxes, was, fastest = {}, {}, 0
for row = 0, rows - 1 do
    for i = 0, rows - row - 1 do
        local b = body { box { 1, 1 }, material = wood, at = {(i - (rows - row - 1) / 2) * (1 - share), 0.5 + row * (1 - share)} }
        boxes[#boxes + 1], was[#was + 1] = b, {b:position()}
    end
end
every_step(function()
    for i, b in ipairs(boxes) do
        local x, y = b:position()
        local dx, dy = x - was[i][1], y - was[i][2]
        fastest = math.max(fastest, math.sqrt(dx * dx + dy * dy) * 60)
        was[i] = {x, y}
    end
end)
expect { "nothing is faster than 6 m/s", test = function() return fastest <= 6, fastest, 6 end }
