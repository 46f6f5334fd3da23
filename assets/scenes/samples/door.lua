-- door.lua - seen from above: swing doors on sprung hinges. A ball pushes them open and goes through; they swing back and close.
-- A door with limits stops at them, however hard it is struck.
scene { title = "Doors", gravity = {0, 0}, duration = 8 }
camera { fit = {{-6, -4}, {10, 4}}, at = 1.1, trail = 1 }
body { type = "static", box { 0.3, 2, at = {0, 3} }, box { 0.3, 2, at = {0, -3} }, box { 0.3, 2, at = {6, 3} }, box { 0.3, 2, at = {6, -3} }, color = "#8792a2" }
local function leaf(name, x, side, color)
    return body { name = name, box { 0.15, 1.85 }, at = {x, side * 1}, density = 10, angular_damping = 0.2, color = color }
end
for side = -1, 1, 2 do
    revolute { leaf("swing" .. side, 0, side, 1), at = {0, side * 1.95}, spring = { frequency = 0.5, damping = 0.8 }, name = "swing" .. side }
    revolute { leaf("stopped" .. side, 6, side, 2), at = {6, side * 1.95}, limits = {-0.9, 0.9}, name = "stopped" .. side }
end
body { name = "ball", circle { 0.5 }, at = {-5, 0.1}, velocity = {6, 0}, mass = 30, color = 3 }
local opened = 0
every_step(function() opened = math.max(opened, math.abs(find_joint("swing1"):value())) end)
expect { "the ball goes through both", body = "ball", x = {7, 60} }
expect { "the doors swing open", test = function() return opened > 0.5, opened, 0.5 end }
expect { "and close again", body = "swing*", angle = 0, tolerance = 0.05 }
expect { "limits hold the others", always = true, joint = "stopped*", joint_value = {-0.95, 0.95} }
expect { "hinges hold", always = true, max_joint_error = 0.03 }
