-- spinner.lua - a bar on a motor turns in a round pit of 120 discs, boxes and capsules and stirs them (Box2D's benchmarks Spinner,
-- Tumbler and Washer). Nobody leaves the pit, the motor keeps its speed, and nobody is shot.
-- watchdog: allow sinking: a strong motor crushes light things against the wall
scene { title = "Spinner", duration = 6, seed = 8 }
camera { fit = {{-9, -8}, {9, 8}}, at = 5 }
local ring = {}
for i = 0, 39 do local a = 2 * math.pi * i / 40 ring[#ring + 1] = { 7 * math.cos(a), 7 * math.sin(a) } end
ring.closed = true
body { name = "pit", type = "static", chain(ring) }
local bar = body { name = "bar", box { 4, 0.4, round = 0.1 }, at = {0, -2.6}, density = 20, color = 1 }
revolute { bar, at = {0, -2.6}, motor = { speed = 4, torque = 4000 }, name = "axle" }
for i = 0, 119 do
    local shape = i % 3 == 0 and circle { 0.25 } or i % 3 == 1 and box { 0.4, 0.4 } or capsule { 0.3, 0.15 }
    body { name = "thing" .. i, shape, at = {(i % 15 - 7) * 0.6, 0.6 * (i // 15) - 1.5}, color = 2 + i % 3 }
end
expect { "nobody leaves the pit", always = true, body = "thing*", x = {-7, 7}, y = {-7, 7} }
expect { "the motor keeps its speed", from = 2, body = "bar", spin = {2, 4.5} }
expect { "nobody is shot", always = true, body = "thing*", max_speed = 30 }
expect { "the axle holds", always = true, max_joint_error = 0.03 }
