-- overhang.lua - four books on the edge of a table, each out by f L / 2k over the one below (k from the top): they stand
-- up to f = 1. The quantity is the f halfway between the boldest stack that stands and the first that has fallen; stacks
-- are 0.004 apart.
-- Source: the harmonic stack, e.g. Hall, Am. J. Phys. 73 (2005) 1107. Hard: all books tip at once; soft contacts sink at
-- the edges.
-- Aim: 0.002.
scene { title = "Book overhang", duration = 5, description = "How far four books reach over the edge." }
local l, thick, n = 1, 0.1, 16
local paper = material { friction = 0.8, density = 500 }
local stacks = {}
for i = 1, n do
    local f = 1 + 0.004 * (i - n / 2 - 0.5)
    local x = 6 * i
    body { name = "table" .. i, type = "static", box { 2, 0.5 }, at = {x - 1, -0.25}, material = paper }
    local edge, top = x, nil
    for k = 4, 1, -1 do
        edge = edge + f * l / (2 * k)
        top = body { name = "book" .. i .. "_" .. k, box { l, thick }, at = {edge - l / 2, (4.5 - k) * thick},
                material = paper, sleep = false }
    end
    stacks[i] = { f = f, top = top }
end
exact { "threshold", at = 5, value = function() return 1 end, measure = function()
    local stands, falls = 0, 2
    for _, s in ipairs(stacks) do
        local _, y = s.top:position()
        if y > 3.2 * thick then stands = math.max(stands, s.f) else falls = math.min(falls, s.f) end
    end
    return (math.max(stands, 0.968) + math.min(falls, 1.032)) / 2
end }
expect { "the threshold", exact = "threshold", tolerance = 0.03 }
