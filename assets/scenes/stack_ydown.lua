-- stack_ydown.lua - the falling stack in screen convention: y grows downwards, gravity is (0, +9.81).
-- Shows: the y axis is a property of the world; the numbers mirror those of stack.lua.
scene { title = "Falling stack, y down", y = "down", duration = 10,
        description = "The same as stack.lua with the origin at the top, as on a screen." }
camera { fit = {{-6, -12.5}, {6, 1}} }

local count = param("count", 10, 1, 50)
local ground = material { name = "ground", friction = 0.8 }
local wood = material { name = "wood", density = 600, friction = 0.6 }

body { name = "ground", type = "static", box { 40, 1 }, at = {0, 0.5}, material = ground }
for i = 1, count do
    body { name = "crate" .. i, box { 1, 1 }, at = {0, -((i - 1) * 1.15 + 0.6)}, material = wood, color = i % 10 }
end

expect { "the crates rest", at = 10, max_speed = 0.01 }
expect { "the top crate is on top", at = 10, body = "crate" .. count, x = 0, y = 0.5 - count, tolerance = 0.05 }
expect { "little overlap at rest", at = 10, max_penetration = 0.005 }
