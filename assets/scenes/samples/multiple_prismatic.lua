-- multiple_prismatic.lua - a telescope of five sections, each sliding in the one before it: held upright by the last one's motor it
-- stretches to the sum of the limits, let go it draws in; its sections stay in line.
scene { title = "Prismatic joints in a row", duration = 6 }
camera { fit = {{-5, -1}, {5, 9}}, at = 3 }
body { name = "base", type = "static", box { 3, 0.4 }, at = {0, -0.2} }
local n, last = 5, "base"
for i = 1, n do
    local section = body { name = "section" .. i, box { 1.2 - 0.2 * i, 1 }, at = {0, 0.5}, mass = 2, collides = {}, color = i }
    prismatic { last, section, axis = {0, 1}, limits = {0, 0.9}, name = "slide" .. i, motor = { speed = 0.5, force = 250 } }
    last = section
end
at(4, function() for i = 1, n do find_joint("slide" .. i):set_motor(-0.5, 250) end end)
expect { "it stretches to the sum of its limits", at = 3.9, body = "section" .. n, y = 0.5 + 0.9 * n, tolerance = 0.05 }
expect { "it draws in", at = 6, body = "section" .. n, y = 0.5, tolerance = 0.05 }
expect { "each section keeps its limits", always = true, joint = "slide*", joint_value = {-0.02, 0.92} }
expect { "they stay in line", always = true, body = "section*", x = 0, angle = {-0.01, 0.01}, tolerance = 0.01 }
