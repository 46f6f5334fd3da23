-- falling_hinges.lua - columns of boxes, every two of them hinged to one another at a corner, fall in a heap on the ground. Hinges
-- keep within their limits and the heap comes to rest. (The same bits on every machine are tested on all scenes.)
scene { title = "Falling hinges", duration = 10 }
camera { fit = {{-10, -1}, {14, 14}}, at = 1.5 }
body { type = "static", box { 60, 1 }, at = {0, -0.5} }
for c = 1, 4 do
    local last
    for r = 1, 12 do
        local x, y = 4 * (c - 1) - 5 + 0.1 * (r % 2), 0.6 * r + 1
        local it = body { name = ("box%d_%d"):format(c, r), box { 0.5, 0.5, round = 0.02 }, at = {x, y}, color = c }
        if r % 2 == 0 then revolute { last, it, at = {x - 0.3, y - 0.3}, limits = {-0.3, 1.2}, name = ("hinge%d_%d"):format(c, r), motor = { speed = 0, torque = 0.05 } } end
        last = it
    end
end
expect { "hinges keep within their limits", always = true, joint = "hinge*", joint_value = {-0.45, 1.35} }
expect { "no hinge opens by a fifth of a box", always = true, max_joint_error = 0.1 }
expect { "nothing sinks into the ground", always = true, body = "box*", y = {0.2, 9} }
expect { "the heap is at rest", from = 9, max_speed = 0.1 }
expect { "it has fallen: no column stands", body = "box1_12", y = {0.2, 6} }
