-- doohickey.lua - six gadgets, two wheels on bars that a sprung slide ties together, fall in a heap and roll apart. Slides keep to
-- their limits, axles to their bars.
scene { title = "Doohickeys", duration = 8 }
camera { fit = {{-10, -1}, {10, 9}}, at = 1.6 }
body { type = "static", box { 40, 1, at = {0, -0.5} }, box { 1, 6, at = {-12, 3} }, box { 1, 6, at = {12, 3} } }
local rubber = material { friction = 0.8, rolling_resistance = 0.02 }
for i = 1, 6 do
    local x, y, d = (i % 3 - 1) * 0.8, 1.5 * i, "doohickey" .. i
    local function part(name, shape, dx) return body { name = name .. i, shape, at = {x + dx, y}, apart = d, material = rubber, color = i } end
    local left, right = part("left", circle { 0.5 }, -1.2), part("right", circle { 0.5 }, 1.2)
    local bar1, bar2 = part("bar1_", capsule { 1.2, 0.1 }, -0.6), part("bar2_", capsule { 1.2, 0.1 }, 0.6)
    revolute { bar1, left, at = {x - 1.2, y}, motor = { speed = 0, torque = 0.1 } }
    revolute { bar2, right, at = {x + 1.2, y}, motor = { speed = 0, torque = 0.1 } }
    prismatic { bar1, bar2, axis = {1, 0}, limits = {-0.3, 0.3}, spring = { frequency = 2, damping = 0.5 }, name = "slide" .. i }
end
expect { "slides keep to their limits", always = true, joint = "slide*", joint_value = {-0.35, 0.35} }
expect { "no joint comes apart by 6 cm", always = true, max_joint_error = 0.06 }
expect { "all lie on the ground or on one another", body = "*", y = {-1, 8}, x = {-13, 13} }
expect { "they come to rest", max_speed = 0.2 }
