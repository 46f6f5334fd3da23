-- revolute.lua - hinges: an arm driven at 2 rad/s, an arm that falls to its limit and lies on it, an arm on a spring that
-- sags by (m g L / 2) / k, and a heavy ball on a hinged bar that swings with its energy.
scene { title = "Revolute joints", duration = 8 }
camera { fit = {{-8, -3.5}, {10, 3}}, at = 1.3, trail = 1 }
local L, m, k = 2, 3, 200
local function arm(name, x, color)
    return body { name = name, box { L, 0.2 }, at = {x + L / 2, 0}, mass = m, color = color, collides = {} }
end
revolute { arm("driven", -6, 1), at = {-6, 0}, motor = { speed = 2, torque = 100 }, name = "motor" }
revolute { arm("limited", -1, 2), at = {-1, 0}, limits = {-radians(40), radians(40)}, name = "limit" }
revolute { arm("sprung", 3, 3), at = {3, 0}, spring = { stiffness = k, damper = 20 }, name = "spring" }
local swing = body { name = "swing", at = {8, 0}, circle { 0.4, at = {1.6, 0} }, box { 1.6, 0.1, at = {0.8, 0} }, color = 4, collides = {} }
revolute { swing, at = {8, 0}, name = "swing" }
expect { "the motor turns it at 2 rad/s", from = 0.5, test = function()
    local off = math.abs(find("driven"):spin() - 2) return off < 0.02, find("driven"):spin(), 2
end }
expect { "it lies on its limit", from = 5, joint = "limit", joint_value = {-radians(40.5), -radians(39.5)} }
expect { "the limit is not passed by a degree", always = true, joint = "limit", joint_value = {-radians(41), radians(1)} }
-- k a = m g L / 2 cos a
local a = 0
for _ = 1, 50 do a = m * 9.81 * L / 2 * math.cos(a) / k end
expect { "the spring sags by its torque over k", from = 6, joint = "spring", joint_value = {-a - 0.002, -a + 0.002} }
expect { "the swing keeps its energy", always = true, test = function()
    local x, y = swing:center()
    local v, w = swing:speed(), swing:spin()
    local vx, vy = swing:velocity()
    local e = swing:mass() * (9.81 * y + (vx * vx + vy * vy) / 2) + swing:inertia() * w * w / 2
    local off = math.abs(e) / (swing:mass() * 9.81 * 1.4)
    return off < 0.03, off, 0.03
end }
expect { "hinges hold", always = true, max_joint_error = 0.005 }
