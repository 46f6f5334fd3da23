-- separation.lua - one joint of each kind holds a box to a post; after a second each box is struck by 60 N s at its edge. Joints give,
-- by less than a centimetre, and come together again.
scene { title = "Joint separation", gravity = {0, 0}, duration = 3 }
camera { fit = {{-3, -2}, {17, 4}}, at = 1.05 }
local m = 5
local makers = {
    function(b, x) return distance { world, b, at_a = {x, 0}, at_b = {x + 1, 0} } end,
    function(b, x) return revolute { b, at = {x + 0.5, 0} } end,
    function(b, x) return weld { b, at = {x + 0.5, 0} } end,
    function(b, x) return prismatic { b, axis = {0, 1}, limits = {-0.2, 0.2} } end,
    function(b, x) return wheel { b, axis = {0, 1}, spring = { frequency = 3, damping = 0.7 }, limits = {-0.2, 0.2} } end,
}
for k, make in ipairs(makers) do
    local x = 3 * (k - 1)
    body { type = "static", box { 0.2, 0.2 }, at = {x, 0}, color = "#8792a2", collides = {} }
    local b = body { name = "box" .. k, box { 1, 1 }, at = {x + 1, 0}, mass = m, angular_damping = 3, damping = 1, color = k }
    make(b, x)
    at(1, function() b:apply_impulse(60, 0, x + 1, 0.5) end)
end
expect { "none comes apart by a centimetre", always = true, max_joint_error = 0.01 }
expect { "all are together again", from = 1.5, max_joint_error = 1e-3 }
for k = 3, 5 do -- those that let nothing move along the blow
    expect { ("box %d is where it was"):format(k), from = 1.5, body = "box" .. k, x = 3 * (k - 1) + 1, tolerance = 0.01 }
end
expect { "the hinged box stays on its hinge", always = true, test = function()
    local x, y = find("box2"):position()
    local off = math.abs(math.sqrt((x - 3.5) * (x - 3.5) + y * y) - 0.5)
    return off < 0.01, off, 0.01
end }
