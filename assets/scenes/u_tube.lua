-- u_tube.lua - water in a bent tube swings to and fro, and carries two corks.
-- Shows: liquid{} between walls that are no lines of its grid; a thread of length L swings in 2 pi sqrt(L / 2 g), whatever its width,
-- and none of it is lost.
scene { title = "U-tube", duration = 12, description = "A thread of water swings with the period of its length." }
camera { fit = { {-2.2, -1.4}, {2.2, 1.9} }, at = 0.4 }
local glass = material { density = 2000, friction = 0.1 }
local cork = material { density = 250, friction = 0.1 }
local bore, bend, level, rise = 0.4, 0.9, 0.6, 0.45 -- bend: radius of the middle line; the left arm begins higher than the level by the rise
local inside, outside = bend - bore / 2, bend + bore / 2

-- Points of half a circle below the origin, from the left to the right.
local function half_circle(radius)
    local points = {}
    for i = 0, 32 do
        local angle = math.pi * (1 + i / 32)
        points[i + 1] = { radius * math.cos(angle), radius * math.sin(angle) }
    end
    return points
end

local core, shell = half_circle(inside), half_circle(outside)
table.insert(core, 1, { -inside, 1.5 })
core[#core + 1] = { inside, 1.5 }
body { name = "core", type = "static", outline(core), material = glass, color = "#9fb8c8" }
local back = half_circle(outside + 0.16)
table.insert(shell, 1, { -outside, 1.7 })
shell[#shell + 1] = { outside, 1.7 }
shell[#shell + 1] = { outside + 0.16, 1.7 }
for i = #back, 1, -1 do shell[#shell + 1] = back[i] end
shell[#shell + 1] = { -outside - 0.16, 1.7 }
body { name = "tube", type = "static", outline(shell), material = glass, color = "#9fb8c8" }

local water, ring = half_circle(outside), half_circle(inside)
table.insert(water, 1, { -outside, level + rise })
water[#water + 1] = { outside, level - rise }
water[#water + 1] = { inside, level - rise }
for i = #ring, 1, -1 do water[#water + 1] = ring[i] end
water[#water + 1] = { -inside, level + rise }
liquid { spacing = param("spacing", 0.025, 0.02, 0.05), outline(water) }
for side = -1, 1, 2 do
    body { circle { 0.12 }, at = { side * bend, level - side * rise + 0.16 }, material = cork, color = "#c98b52" }
end

-- What is not in the bend is in the arms; round the bend water flows as 1 / radius.
local area = liquid_in(-9, -9, 9, 9)
local length = (area - math.pi / 2 * (outside^2 - inside^2)) / bore + math.pi * bore / math.log(outside / inside)
local period = 2 * math.pi * math.sqrt(length / (2 * 9.81))
local crossings, before = {}, -1
every(1 / 60, function(t)
    local _, _, _, x = liquid_in(-9, -9, 9, 9)
    if x * before < 0 then crossings[#crossings + 1] = t - 1 / 60 * x / (x - before) end
    before = x
end)
expect { "three swings take three periods", at = 12, test = function()
    local measured = (crossings[7] - crossings[1]) / 3
    return math.abs(measured / period - 1) < 0.05, measured, period
end }
expect { "none of the water is lost", always = true, test = function() local now = liquid_in(-9, -9, 9, 9) return now == area, now, area end }
expect { "the swing is still there", at = 12, test = function() return #crossings >= 8, #crossings, 8 end }
