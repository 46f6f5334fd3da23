-- vertical_stack.lua - four columns of twelve boxes stand for 3 s; then light bullets of 10 cm come at 200 m/s, 3.3 m a
-- step. Each must meet a box, none may pass through, and what they bring is what the boxes get.
scene { title = "Vertical stacks under fire", duration = 6 }
camera { fit = {{-12, -1}, {20, 14}}, at = 3.5 }
local columns, rows, speed, shots = 4, 12, 200, 5
body { type = "static", box { 200, 1 }, at = {0, -0.5} }
for c = 1, columns do
    for r = 1, rows do
        body { name = ("box%d_%d"):format(c, r), box { 0.9, 0.9 }, at = {3 * (c - 1), 0.9 * r - 0.45}, color = c }
    end
    local top = ("box%d_%d"):format(c, rows)
    expect { ("column %d stands until then"):format(c), from = 0, till = 2.9, body = top, x = {3 * c - 3.01, 3 * c - 2.99},
             y = {0.9 * rows - 0.5, 0.9 * rows - 0.44} }
end
local met, ahead = {}, -1
at(3, function()
    for i = 1, shots do
        body { name = "bullet" .. i, circle { 0.05 }, at = {-10, 2 * i - 0.6}, velocity = {speed, 0}, mass = 0.05,
               continuous = true, gravity_scale = 0, color = "#d64545" }
    end
end)
on_contact { a = "bullet*", b = "box*", function(bullet, box) met[bullet:name()] = met[bullet:name()] or box end }
every_step(function()
    for name, box in pairs(met) do ahead = math.max(ahead, (find(name):position()) - (box:position())) end
end)
expect { "every bullet meets the first column", at = 3.2, test = function()
    local hits = 0
    for i = 1, shots do if met["bullet" .. i] then hits = hits + 1 end end
    return hits == shots, hits, shots
end }
expect { "no bullet is ever ahead of the box that it met", at = 3.2, test = function() return ahead < 0, ahead, 0 end }
expect { "the columns are hit, not blown away", body = "box*", x = {-20, 30}, y = {0.3, 0.9 * rows} }
