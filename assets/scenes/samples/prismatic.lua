-- prismatic.lua - slides: a motor lifts a block at 1 m/s (reached with 1 g) to its upper limit and holds it there; one too weak for the weight
-- sinks to the lower limit; a block on a sprung slide sags by m g / k; one slides down an inclined axis by g sin.
scene { title = "Prismatic joints", duration = 5 }
camera { fit = {{-7, -3}, {8, 4}}, at = 1, trail = 1 }
local m = 10
local function block(name, x, y, color) return body { name = name, box { 1, 1 }, at = {x, y}, mass = m, color = color, collides = {} } end
prismatic { block("lifted", -6, 0, 1), axis = {0, 1}, limits = {-2, 3}, motor = { speed = 1, force = 2 * m * 9.81 }, name = "strong" }
prismatic { block("weak", -3, 0, 2), axis = {0, 1}, limits = {-2, 3}, motor = { speed = 1, force = 0.9 * m * 9.81 }, name = "weak" }
prismatic { block("sprung", 0, 0, 3), axis = {0, 1}, spring = { stiffness = 200, damper = 60 }, name = "sprung" }
local s = radians(30)
prismatic { block("sliding", 3, 3, 4), axis = {math.cos(s), -math.sin(s)}, limits = {0, 5}, name = "inclined" }
expect { "the strong one rises at 1 m/s, 0.1 s after it began", at = 2, joint = "strong", joint_value = {1.94, 1.96} }
expect { "and is held at the limit", from = 3.2, joint = "strong", joint_value = {2.99, 3.01} }
expect { "the weak one sinks by 0.1 g", at = 1, joint = "weak", joint_value = {-0.1 * 9.81 / 2 - 0.02, -0.1 * 9.81 / 2 + 0.02} }
expect { "to its limit", at = 5, joint = "weak", joint_value = {-2.01, -1.99} }
expect { "the spring sags by m g / k", from = 4, joint = "sprung", joint_value = {-m * 9.81 / 200 - 0.005, -m * 9.81 / 200 + 0.005} }
expect { "down the incline it goes by g sin", at = 1, joint = "inclined", joint_value = {9.81 / 4 - 0.02, 9.81 / 4 + 0.02} }
expect { "and stops at the limit", from = 2, joint = "inclined", joint_value = {4.97, 5.03} }
expect { "none turns", always = true, body = "*", angle = 0, tolerance = 0.005 }
expect { "slides hold", always = true, max_joint_error = 0.01 }
