-- wake_touching.lua - twelve boxes stand in a row, flush with one another, and sleep. The one in the middle is taken
-- away: what touched it wakes, finds rest and sleeps again where it was. A box that is woken by a call wakes its island.
scene { title = "Wake what touches", duration = 8 }
camera { fit = {{-7, -1}, {7, 4}}, at = 4.1 }
body { type = "static", box { 40, 1 }, at = {0, -0.5} }
for i = 1, 12 do body { name = "row" .. i, box { 1, 1 }, at = {i - 6.5, 0.5}, color = 1 } end
for i = 1, 5 do body { name = "top" .. i, box { 1, 1 }, at = {i + 0.5, 1.5}, color = 2 } end
local seen = {}
local function awake()
    local n = 0
    for i = 1, 12 do local b = find("row" .. i) if b and b:awake() then n = n + 1 end end
    for i = 1, 5 do if find("top" .. i):awake() then n = n + 1 end end
    return n
end
at(2.9, function() seen.before = awake() end)
at(3, function() find("row6"):destroy() end)
every_step(function(t) if t > 3 and t < 3.3 then seen.after = math.max(seen.after or 0, awake()) end end)
at(6, function() seen.again = awake() find("row12"):wake() end)
every_step(function(t) if t > 6 and t < 6.1 then seen.woken = math.max(seen.woken or 0, awake()) end end)
expect { "all sleep", at = 3, test = function() return seen.before == 0, seen.before, 0 end }
expect { "what touched it wakes", at = 3.4, test = function() return seen.after >= 2, seen.after, 2 end }
expect { "and sleeps again", at = 6.1, test = function() return seen.again == 0, seen.again, 0 end }
expect { "a call wakes the island of a box", at = 6.2, test = function() return seen.woken >= 5, seen.woken, 5 end }
expect { "nobody has moved", body = "top*", y = 1.5, angle = {-0.001, 0.001}, tolerance = 0.01 }
