-- discs.lua - 400 discs fall into a box; frictionless and without rotation unless asked otherwise.
-- Shows: what is not asked for is not paid for. Compare `plumb explain` of this scene with the same and
-- `--set friction=0.5 --set turning=1`; the project's README has the instruction counts.
scene { title = "Discs", description = "Discs that neither rub nor turn.", duration = 5 }
camera { fit = {{-11, -1}, {11, 16}} }

local friction = param("friction", 0.0, 0, 10)
local turning = param("turning", 0, 0, 1)
local smooth = material { name = "smooth", density = 1, friction = friction }

body { name = "box", type = "static", material = smooth, color = "#4a5568",
       box { 22, 1, at = {0, -0.5} }, box { 1, 15, at = {-10.5, 7.5} }, box { 1, 15, at = {10.5, 7.5} } }
for i = 0, 399 do
    body {
        name = "disc" .. i + 1,
        circle { 0.3 + 0.1 * (i % 3) / 2 },
        at = {(i % 20 - 9.5) * 0.9 + 0.05 * (i // 20 % 2), 0.5 + (i // 20) * 0.9},
        fixed_rotation = turning == 0,
        material = smooth,
        color = i % 10,
    }
end

expect { "all stay in the box", at = 5, body = "disc*", x = {-10, 10}, y = {0, 20} }
expect { "they lie still", at = 5, max_speed = 1.5 }
expect { "little overlap", at = 5, max_penetration = 0.03 }
