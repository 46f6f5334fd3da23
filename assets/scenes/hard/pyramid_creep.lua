-- pyramid_creep.lua - a pyramid of ten rows is looked at for a minute, without sleep.
-- Fails: friction that anchors anew each step lets piles spread by millimetres a minute. Right: what rests, rests.
scene { title = "Creep", duration = 60, sleep = false }
local rows, apart = param("rows", 10, 1, 40), param("apart", 1.05, 1, 1.5)
local stone = material { density = 1000, friction = 0.6 }
body { type = "static", box { 60, 1 }, at = {0, -0.5}, material = stone }
local boxes, was = {}, {}
for row = 1, rows do
    for i = 1, rows - row + 1 do
        boxes[#boxes + 1] = body { box { 1, 1 }, at = {(i - (rows - row + 2) / 2) * apart, row - 0.5}, material = stone }
    end
end
at(10, function() for i, b in ipairs(boxes) do was[i] = {b:position()} end end)
expect { "no box moves by a millimetre in 50 s", test = function()
    local most = 0
    for i, b in ipairs(boxes) do
        local x, y = b:position()
        most = math.max(most, math.abs(x - was[i][1]), math.abs(y - was[i][2]))
    end
    return most <= 1e-3, most, 1e-3
end }
