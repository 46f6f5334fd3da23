-- dt_random.lua - a pyramid, and every frame in another number of steps, 1 to 16, by chance.
-- Fails: whoever ties stiffness to the step. Right: no box moves by a millimetre once it lies.
scene { title = "A pyramid, random steps", duration = 6, sleep = false, seed = 7 }
local rows = param("rows", 6, 1, 20)
local stone = material { density = 1000, friction = 0.6 }
body { type = "static", box { 60, 1 }, at = {0, -0.5}, material = stone }
local boxes, was = {}, {}
for row = 1, rows do
    for i = 1, rows - row + 1 do
        boxes[#boxes + 1] = body { box { 1, 1 }, at = {(i - (rows - row + 2) / 2) * 1.05, row - 0.5}, material = stone }
    end
end
at(1, function() for i, b in ipairs(boxes) do was[i] = {b:position()} end end)
every_step(function(t) if t >= 1 then split_step(random_int(1, 16)) end end)

local function moved()
    local most = 0
    for i, b in ipairs(boxes) do
        local x, y = b:position()
        most = math.max(most, math.abs(x - was[i][1]), math.abs(y - was[i][2]))
    end
    return most
end
expect { "no box hops or creeps", from = 1.1, test = function() local d = moved() return d <= 1e-3, d, 1e-3 end }
