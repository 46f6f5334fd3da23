-- lamp.lua - a desk lamp of three arms that lie on the limits of their hinges, with a heavy head.
-- Fails: soft limits: 0.38 rad past the limit here, 0.66 in Box2D, and the classic solver diverges. Right: a limit is a
-- stop: no arm passes it by more than a degree.
-- lint: allow mass-ratio: the head is what it asks
scene { title = "Lamp at its limits", duration = 5 }
local head, arms = param("head", 50, 1, 1e6), 3
local last = body { type = "static", box { 0.5, 0.5 }, at = {-0.25, 0} }
for i = 1, arms do
    local arm = body { name = "arm" .. i, box { 1, 0.1 }, at = {i - 0.5, 0}, mass = 2, apart = "lamp" }
    revolute { last, arm, at = {i - 1, 0}, limits = {-0.1, 0.1}, name = "hinge" .. i }
    last = arm
end
local bulb = body { name = "head", circle { 0.3 }, at = {arms, 0}, mass = head, apart = "lamp" }
weld { last, bulb, at = {arms, 0} }
expect { "no hinge passes its limit by a degree", from = 0.1, joint = "hinge*", joint_value = {-0.1175, 0.1175} }
expect { "the head is where the stops have it", body = "head", tolerance = 0.06, position = {
    math.cos(0.1) + math.cos(0.2) + math.cos(0.3), -math.sin(0.1) - math.sin(0.2) - math.sin(0.3)} }
expect { "no hinge comes apart", always = true, max_joint_error = 0.01 }
