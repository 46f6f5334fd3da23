-- copies_scaled.lua - Froude: a pyramid of boxes of 0.25, 1 and 4 m, each struck by a box at a speed that goes with the
-- root of the size. Seen in sizes, at times that go with the root as well, they do the same.
-- Fails: slops, thresholds and push speeds in metres and seconds. Right: they agree as far as the steps differ.
scene { title = "Froude copies", duration = 4.1 }
local sizes, copies = { 0.25, 1, 4 }, {}
local wood = material { density = 600, friction = 0.6 }
local shot_speed = param("speed", 6, 0, 100)
for k, s in ipairs(sizes) do
    local cx = k * 100
    copies[k] = { root = math.sqrt(s), samples = {} }
    body { type = "static", box { 60 * s, s }, at = {cx, -0.5 * s}, material = wood }
    local function put(x, y, vx)
        copies[k][#copies[k] + 1] = body { box { s, s }, at = {x, y}, velocity = {vx, 0}, material = wood }
    end
    for row = 1, 4 do
        for i = 1, 5 - row do
            put(cx + (i - (6 - row) / 2) * 1.05 * s, (row - 0.5) * s, 0)
        end
    end
    put(cx - 8 * s, 0.5 * s, shot_speed * math.sqrt(s))
end
-- Places in sizes, at the same dimensionless times 0.5, 1, 2 (in roots of metres over g's unit).
for k, s in ipairs(sizes) do
    local c = copies[k]
    for _, time in ipairs { 0.5, 1, 2 } do
        at(time * c.root, function()
            local list = {}
            for i, b in ipairs(c) do
                local x, y = b:position()
                list[i] = { (x - k * 100) / s, y / s }
            end
            c.samples[time * 2] = list
        end)
    end
end
local function apart(k, time)
    local off = 0
    for i, p in ipairs(copies[k].samples[time * 2]) do
        local q = copies[2].samples[time * 2][i]
        off = math.max(off, math.abs(p[1] - q[1]), math.abs(p[2] - q[2]))
    end
    return off
end
for _, k in ipairs { 1, 3 } do
    expect { ("%g m does as 1 m, by a tenth of a box"):format(sizes[k]), test = function()
        local d = math.max(apart(k, 0.5), apart(k, 1), apart(k, 2))
        return d <= 0.1, d, 0.1
    end }
end
