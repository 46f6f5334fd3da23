-- windmill.lua - a rotor of four arms welded to a small hub of the same mass, driven at 3 rad/s, tosses boxes about. A hub with a
-- hundredth of the arms' moment of inertia is where rotors shake themselves apart. Right: it turns as told, and its welds hold.
-- lint: allow mass-ratio: the light hub is what it asks
-- watchdog: allow energy-jump, runaway-speed, torn-joint, contact-without-touch, tunnelling, sinking, pair-explosion: they are right, see open.txt
scene { title = "Windmill", duration = 8 }
camera { fit = {{-7, -1}, {7, 9}}, at = 4 }
body { type = "static", box { 14, 1, at = {0, -0.5} }, box { 1, 9, at = {-6.5, 4.5} }, box { 1, 9, at = {6.5, 4.5} } }
local hub = body { name = "hub", circle { 0.4 }, at = {0, 4}, mass = 1, apart = "rotor", color = 1 }
revolute { hub, at = {0, 4}, motor = { speed = 3, torque = 1000 }, name = "axle" }
for i = 0, 3 do
    local a = i * math.pi / 2
    local arm = body { name = "arm" .. i, box { 2.6, 0.3 }, at = {1.7 * math.cos(a), 4 + 1.7 * math.sin(a)}, angle = a, mass = 1, apart = "rotor", color = 2 }
    weld { hub, arm, at = {0.4 * math.cos(a), 4 + 0.4 * math.sin(a)}, name = "weld" .. i }
end
for i = 1, 12 do body { name = "box" .. i, box { 0.5, 0.5 }, at = {(i % 6) * 1.6 - 4, 7.2 + 0.7 * (i // 7)}, mass = 0.3, color = 3 } end
expect { "it turns at 3 rad/s", from = 0.5, body = "hub", spin = {2.7, 3.3} }
expect { "welds hold", always = true, joint = "weld*", max_joint_error = 0.05 }
expect { "the axle holds", always = true, joint = "axle", max_joint_error = 0.01 }
expect { "no box leaves", always = true, body = "box*", x = {-6, 6}, y = {0.2, 30} }
