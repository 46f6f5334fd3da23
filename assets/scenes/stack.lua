-- stack.lua - ten crates are dropped a little apart, land on one another and come to rest.
-- Shows: restitution 0 landings, a column that settles and stays.
scene { title = "Falling stack", description = "Ten crates fall, land on one another and stay.", duration = 10 }
camera { fit = {{-6, -1}, {6, 12.5}} }

local count = param("count", 10, 1, 50)
local ground = material { name = "ground", friction = 0.8 }
local wood = material { name = "wood", density = 600, friction = 0.6 }

body { name = "ground", type = "static", box { 40, 1 }, at = {0, -0.5}, material = ground }
for i = 1, count do
    body { name = "crate" .. i, box { 1, 1 }, at = {0, (i - 1) * 1.15 + 0.6}, material = wood, color = i % 10 }
end

expect { "the crates rest", at = 10, max_speed = 0.01 }
expect { "the top crate is on top", at = 10, body = "crate" .. count, x = 0, y = count - 0.5, tolerance = 0.05 }
expect { "little overlap at rest", at = 10, max_penetration = 0.005 }
