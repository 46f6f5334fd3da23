-- motor_joint.lua - a body is driven along a figure of eight by a motor joint whose target a script moves. Strong enough, it
-- follows within a hair, whatever it pushes aside; one whose force is less than its weight sinks to the ground.
scene { title = "Motor joints", duration = 8 }
camera { fit = {{-7, -1}, {7, 8}}, at = 3, trail = 2 }
body { type = "static", box { 40, 1 }, at = {0, -0.5} }
local m = 20
local target = body { name = "target", type = "kinematic", at = {0, 4.8}, circle { 0.1 }, collides = {}, color = "#d64545" }
local strong = body { name = "strong", box { 1.5, 0.6 }, at = {0, 4.8}, mass = m, color = 1 }
local weak = body { name = "weak", box { 1.5, 0.6 }, at = {5.5, 4}, mass = m, color = 2 }
motor { target, strong, max_force = 5000, max_torque = 2000, spring = { frequency = 8, damping = 1 } }
motor { world, weak, max_force = 0.5 * m * 9.81, max_torque = 2000 }
for i = 1, 5 do body { name = "crate" .. i, box { 0.7, 0.7 }, at = {-3.5, 0.7 * i - 0.35}, density = 2, color = 3 } end
local function place(t) local w = 2 * math.pi * t / 4 return 4 * math.sin(w), 4.8 + 1.5 * math.sin(2 * w) end
every_step(function(t) target:move_to(place(t + 1 / 60)) end)
local worst = 0
every_step(function(t)
    if t > 4.5 then -- the crates are swept away
        local x, y = strong:position()
        local px, py = target:position()
        worst = math.max(worst, math.sqrt((x - px) * (x - px) + (y - py) * (y - py)))
    end
end)
expect { "the strong one follows within 10 cm in its second round", test = function() return worst < 0.1, worst, 0.1 end }
expect { "it stays level", always = true, body = "strong", angle = {-0.1, 0.1} }
expect { "the weak one lies on the ground", body = "weak", y = 0.3, angle = {-0.02, 0.02}, tolerance = 0.01 }
expect { "it fell with half of gravity", at = 1, body = "weak", y = 4 - 9.81 / 4, tolerance = 0.05 }
