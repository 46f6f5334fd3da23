-- dominoes.lua - a row of dominoes topples, one after the other.
-- Shows: thin boxes that stand until they are pushed, then a wave of contacts at a steady speed.
scene { title = "Dominoes", description = "One push, and the whole row falls.", duration = 12 }
local count = param("count", 30, 5, 200)
local ivory = material { name = "ivory", density = 1700, friction = 0.4 }
local felt = material { name = "felt", friction = 0.7 }
local pitch = 0.5
camera { fit = {{-1.5, -0.4}, {count * pitch + 1.5, 3.2}} }

body { name = "ground", type = "static", box { count * pitch + 40, 1 }, at = {count * pitch / 2, -0.5}, material = felt }
for i = 1, count do
    body { name = "domino" .. i, box { 0.15, 1.2 }, at = {(i - 1) * pitch, 0.6}, material = ivory,
           color = (i // 3) % 10 }
end

at(0.5, function()
    local first = find("domino1")
    local m = first:mass()
    first:apply_impulse(0.8 * m, 0, 0, 1.1)
end)

expect { "they stand before the push", till = 0.45, body = "domino*", angle = {-0.01, 0.01}, max_speed = 0.02 }
expect { "the last one has fallen", at = 12, body = "domino" .. count, angle = {-2, -1} }
expect { "all have come to rest", at = 12, max_speed = 0.05 }
expect { "little overlap at rest", at = 12, max_penetration = 0.01 }
