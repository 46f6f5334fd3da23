-- dominoes_double.lua - Double Domino of Solver2D: 15 thin boxes, the first pushed. Fails: rolling edges that catch or
-- slide. Right: all fall to the right and come to rest; nothing is thrown.
scene { title = "Double Domino", duration = 8 }
local n = param("n", 15, 2, 60)
local wood = material { density = 600, friction = 0.6 }
body { type = "static", box { 200, 1 }, at = {0, -0.5}, material = wood }
for i = 1, n do body { name = "domino" .. i, box { 0.25, 1 }, at = {(i - 1), 0.5}, material = wood } end
at(0, function() local b = find("domino1") b:apply_impulse(0.2 * b:mass() * 4, 0, 0, 1) end)
expect { "all have fallen", body = "domino*", angle = {-1.65, -0.5} }
expect { "nothing is thrown", always = true, body = "domino*", y = {0.1, 0.56}, x = {-1, n + 1.5} }
