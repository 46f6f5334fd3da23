-- dt_alternating.lua - a frame in one step, the next in four, and so on: a game whose frames vary.
-- Fails: whoever ties stiffness to the step; impulses of the last step that are not scaled to this one.
-- Right: the stack lies still.
scene { title = "A stack, alternating steps", duration = 10, sleep = false }
local n, parts = param("n", 5, 1, 50), param("parts", 4, 1, 1000)
local stone = material { density = 1000, friction = 0.6 }
body { type = "static", box { 40, 1 }, at = {0, -0.5}, material = stone }
for i = 1, n do body { name = "box" .. i, box { 1, 1 }, at = {0, i - 0.5}, material = stone } end
local odd = false
every_step(function() odd = not odd split_step(odd and 1 or parts) end)

expect { "the top never hops", from = 1, body = "box" .. n, y = {n - 0.5 - 0.005 * n, n - 0.5 + 1e-3} }
expect { "nothing walks sideways", body = "box*", x = {-1e-3, 1e-3} }
expect { "nothing turns", from = 1, body = "box*", angle = {-1e-3, 1e-3} }
