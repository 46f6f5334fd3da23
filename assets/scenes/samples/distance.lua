-- distance.lua - rods, ropes and springs: a row of five balls on rods hangs still; a ball on a spring sags by m g / k; one
-- on a slack rope falls freely till the rope is taut and then hangs at its length; a rod turns about its end and keeps it.
scene { title = "Distance joints", duration = 8 }
camera { fit = {{-3, -6}, {9, 1}}, at = 0.5, trail = 0.4 }
local last = world
for i = 1, 5 do
    local ball = body { name = "row" .. i, circle { 0.2 }, at = {-2, -i}, color = 1 }
    distance { last, ball, at_a = last == world and {-2, 0} or nil, name = "rod" .. i }
    last = ball
end
local m, k = 4, 80
body { name = "sprung", circle { 0.3 }, at = {1, -1}, mass = m, color = 2 }
distance { world, "sprung", at_a = {1, 0}, spring = { stiffness = k, damper = 8 }, name = "spring" }
body { name = "hung", circle { 0.3 }, at = {3.5, -0.5}, mass = m, color = 3, angular_damping = 1 }
distance { world, "hung", at_a = {3.5, 0}, limits = {0, 3}, name = "rope" }
body { name = "swing", circle { 0.3 }, at = {8.5, 0}, mass = m, color = 4 }
distance { world, "swing", at_a = {6.5, 0}, name = "rod" }
expect { "the row hangs at its length", always = true, body = "row5", x = -2, y = -5, tolerance = 0.02 }
expect { "the spring sags by m g / k", from = 7, joint = "spring", joint_value = {1 + m * 9.81 / k - 0.01, 1 + m * 9.81 / k + 0.01} }
expect { "a slack rope does not pull", from = 0.1, till = 0.6, test = function()
    local x, y = find("hung"):position()
    local t = time()
    local off = math.abs(y - (-0.5 - 4.905 * t * t)) return off < 1e-3, off, 1e-3
end }
expect { "a taut one holds", from = 0.8, joint = "rope", joint_value = {2.9, 3.02} }
expect { "the rod keeps its length", always = true, joint = "rod", joint_value = {1.99, 2.01} }
expect { "its ball is as fast below as a fall makes it", always = true, test = function()
    local b = find("swing")
    local _, y = b:position()
    local vx, vy = b:velocity()
    local off = math.abs((vx * vx + vy * vy) / 2 + 9.81 * y) / (9.81 * 2)
    return off < 0.02, off, 0.02
end }
expect { "the rope bears the weight", at = 8, joint = "rope", reaction = {m * 9.81 * 0.98, m * 9.81 * 1.02} }
