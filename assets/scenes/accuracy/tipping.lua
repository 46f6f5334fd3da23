-- tipping.lua - boxes 0.5 wide and 1 high on slopes whose tan is f times w / h: they tip from f = 1 on. The quantity is
-- the f halfway between the steepest that stands and the least steep that has fallen; slopes are 0.002 apart.
-- Source: statics: the weight must pass through the base. Hard: soft contacts sink unevenly and shorten the base.
-- Aim: 0.002.
scene { title = "Tipping", duration = 5, description = "At which slope boxes tip over." }
local w, h, n = 0.5, 1, 20
local rough = material { friction = 2 }
local boxes = {}
for i = 1, n do
    local f = 1 + 0.002 * (i - n / 2 - 0.5)
    local angle = math.atan(f * w / h)
    local x = 5 * i
    body { name = "slope" .. i, type = "static", box { 3, 0.5, at = {0, -0.25} }, at = {x, 0}, angle = angle, material = rough }
    boxes[i] = { f = f, angle = angle, body = body { name = "box" .. i, box { w, h }, at = {x - h / 2 * math.sin(angle),
            h / 2 * math.cos(angle)},
                 angle = angle, material = rough, sleep = false } }
end
exact { "threshold", at = 5, value = function() return 1 end, measure = function()
    local stands, falls = 0, 2
    for _, b in ipairs(boxes) do
        if math.abs(b.body:angle() - b.angle) < 0.02 then stands = math.max(stands, b.f) else falls = math.min(falls, b.f) end
    end
    return (math.max(stands, 0.98) + math.min(falls, 1.02)) / 2
end }
expect { "the threshold", exact = "threshold", tolerance = 0.012 }
