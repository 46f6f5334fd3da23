-- pi_1e4.lua - a block 10^4 times as heavy drives a light one against a wall: pi 10^2 elastic blows turn it back.
-- Velocities before the first blow are turned by 2 atan(sqrt(m / M)) with each pair of blows.
-- Source: Galperin, Regular and Chaotic Dynamics 8 (2003) 375. Hard: hundreds of blows in one substep where it turns; none
-- may be left out, or energy is lost.
scene { title = "Counting pi: 1 : 1e4", gravity = {0, 0}, duration = 8, description = "Thousands of blows give all energy back." }
local ratio = 1e4
local steel = material { friction = 0, restitution = 1 }
body { name = "wall", type = "static", box { 1, 2 }, at = {-0.5, 0}, material = steel }
local light = body { name = "light", box { 0.2, 0.2 }, at = {1, 0}, mass = 1, material = steel, fixed_rotation = true,
        sleep = false, color = 1 }
local heavy = body { name = "heavy", box { 0.6, 0.6 }, at = {2, 0}, velocity = {-1, 0}, mass = ratio, material = steel,
        fixed_rotation = true,
                     sleep = false, color = 2 }
-- The same blow by blow: speeds, places, times.
local u, v, x, y, t, blows = -1, 0, 2, 1, 0, 0 -- of the heavy and the light block
local function fly(time)
    x, y, t = x + u * time, y + v * time, t + time
    blows = blows + 1
end
while true do
    if u < v then
        fly((x - 0.3 - (y + 0.1)) / (v - u))
        u, v = ((ratio - 1) * u + 2 * v) / (ratio + 1), ((1 - ratio) * v + 2 * ratio * u) / (ratio + 1)
    elseif v < 0 then
        fly((y - 0.1) / -v)
        v = -v
    else
        break
    end
end
assert(blows == math.pi * math.sqrt(ratio) // 1)
exact { "heavy", body = "heavy", vx = function() return u end, at = 8 }
exact { "heavy, place", body = "heavy", x = function() return x + u * (8 - t) end, at = 8 }
exact { "light, place", body = "light", x = function() return y + v * (8 - t) end, at = 8 }
exact { "light", body = "light", vx = function() return v end, at = 8 }
exact { "energy", at = 8, value = function() return 1 end, measure = function() return energy() / (ratio / 2) end }
expect { "the heavy block's velocity", exact = "heavy", tolerance = 1.5e-08 }
expect { "the heavy block's place", exact = "heavy, place", tolerance = 1e-05 }
expect { "the light block's place", exact = "light, place", tolerance = 1e-4 }
expect { "the light block's velocity", exact = "light", tolerance = 6e-06 }
expect { "the energy", exact = "energy", tolerance = 3e-08 }
