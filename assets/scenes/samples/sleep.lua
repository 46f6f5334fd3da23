-- sleep.lua - a chain of bodies on a hinge, a wall and a pile fall asleep. Then a ball wakes the wall alone, and a floor
-- is taken away from under the pile, which falls.
scene { title = "Sleep", duration = 14 }
camera { fit = {{-10, -4}, {12, 6}}, at = 5.3 }
body { type = "static", box { 12, 1, at = {-4, -0.5} }, box { 30, 1, at = {0, -3.5} } }
local floor = body { name = "floor", type = "static", box { 4, 0.4 }, at = {9, -0.2}, color = "#c08a4a" }
for i = 1, 5 do body { name = "wall" .. i, box { 0.6, 0.6 }, at = {-4, 0.6 * i - 0.3}, color = 1 } end
for i = 1, 3 do body { name = "pile" .. i, box { 0.8, 0.8 }, at = {9, 0.8 * i - 0.4}, color = 2 } end
local last = world
for i = 1, 5 do
    local link = body { name = "link" .. i, capsule { 0.5, 0.08 }, at = {-8 + 0.5 * i - 0.25, 5}, angular_damping = 1, color = 3 }
    revolute { last, link, at = {-8.5 + 0.5 * i, 5}, motor = { speed = 0, torque = 1 } }
    last = link
end
local function awake(what, n)
    local count = 0
    for i = 1, n do if find(what .. i):awake() then count = count + 1 end end
    return count
end
local before = {}
at(4.9, function() before.wall, before.pile = awake("wall", 5), awake("pile", 3) end)
at(5, function() body { name = "ball", circle { 0.3 }, at = {-9, 0.5}, velocity = {12, 3}, density = 5, color = "#d64545" } end)
at(7, function() before.pile_later = awake("pile", 3) floor:destroy() end)
expect { "wall and pile sleep", at = 5, test = function() local n = before.wall + before.pile return n == 0, n, 0 end }
expect { "the ball wakes the wall", at = 5.6, test = function() local n = awake("wall", 5) return n > 0, n, 1 end }
expect { "and not the pile", at = 7.1, test = function() return before.pile_later == 0, before.pile_later, 0 end }
expect { "without a floor the pile falls", at = 9, body = "pile*", y = {-3, -0.5} }
expect { "all sleeps in the end", test = function()
    local n = awake("pile", 3) + awake("wall", 5) + awake("link", 5)
    return n == 0, n, 0
end }
