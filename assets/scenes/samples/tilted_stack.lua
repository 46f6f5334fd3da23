-- tilted_stack.lua - six columns of ten boxes, each box set off from the one below by 0 to 20 cm. The upper k boxes lean
-- out by (k + 1) / 2 steps: ten stand with steps below 10 cm and fall with more.
scene { title = "Tilted stacks", duration = 8 }
camera { fit = {{-3, -1}, {36, 13}}, at = 2.2 }
local n = 10
body { type = "static", box { 120, 1 }, at = {15, -0.5} }
for k, step in ipairs { 0, 0.04, 0.08, 0.12, 0.16, 0.2 } do
    local x = 6 * (k - 1)
    for i = 1, n do
        body { name = ("column%d_%d"):format(k, i), box { 1, 1 }, at = {x + step * (i - 1), i - 0.5}, color = k }
    end
    local top = ("column%d_%d"):format(k, n)
    if step < 0.1 then
        expect { ("steps of %g m stand"):format(step), body = top, y = {n - 0.6, n - 0.49},
                 x = {x + step * (n - 1) - 0.05, x + step * (n - 1) + 0.05} }
    else
        expect { ("steps of %g m fall"):format(step), body = top, y = {0.4, n - 2} }
    end
end
expect { "nothing sinks", from = 6, max_penetration = 0.02 }
