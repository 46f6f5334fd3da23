-- copies_boosted.lua - a cluster is struck without gravity, and again as seen from a train at 30 m/s: all velocities
-- have 30 m/s more. Fails: damping, sleep and thresholds by absolute speed. Right: Galilei: the same seen from the train.
-- (Gaps of 2 cm, up to which Plumb looks for contacts, would leave to rounding whether there is one.)
scene { title = "Boosted copies", gravity = {0, 0}, duration = 1.5 }
local boost = param("boost", 30, -1000, 1000)
local copies = { {}, {} }
for k = 1, 2 do
    local cy, v0 = k * 30, k == 2 and boost or 0
    local function put(shape, x, y, vx)
        copies[k][#copies[k] + 1] = body { shape, at = {x, cy + y}, velocity = {vx + v0, 0}, density = 100 }
    end
    for i = 0, 3 do
        for j = 0, 3 do put(box { 1, 1 }, i * 1.05, j * 1.05, 0) end
    end
    put(circle { 0.5 }, -3, 1.7, 10)
end
local off = 0
every_step(function(t)
    for i, b in ipairs(copies[2]) do
        local x, y = b:position()
        local u, v = copies[1][i]:position()
        off = math.max(off, math.abs(x - boost * t - u), math.abs(y - 30 - v))
    end
end)
expect { "they agree within a centimetre", test = function() return off <= 0.01, off, 0.01 end }
