-- belt_stack.lua - a stack of five on a belt that runs at 2 m/s, one on a belt the other way, one on a belt that starts
-- at 5 s. Fails: surface speed that is pushed in with every sweep topples stacks. Right: they ride, upright, at the
-- belt's speed; friction 0.1 on the belt is too little to tip them, 0.6 between boxes enough to keep them together.
scene { title = "Stacks on belts", duration = 8 }
local n = param("n", 5, 1, 20)
local wood = material { density = 600, friction = 0.6 }
local belts = { material { surface_speed = 2 }, material { surface_speed = -2 }, material {} }
for k = 1, 3 do
    material_pair { belts[k], wood, friction = 0.1 }
    body { type = "static", box { 60, 1 }, at = {0, k * 12 - 12.5}, material = belts[k] }
    for i = 1, n do
        body { name = ("box%d_%d"):format(k, i), box { 1, 0.6 }, at = {0, k * 12 - 12 + i * 0.6 - 0.3}, material = wood }
    end
end
at(5, function() belts[3]:set { surface_speed = 2 } end)
-- What is brought to speed v by mu g has gone v t - v^2 / (2 mu g).
local function rode(t) return 2 * t - 4 / (2 * 0.1 * 9.81) end
expect { "the first ride to the right", body = "box1_*", x = rode(8), tolerance = 0.1 }
expect { "the second to the left", body = "box2_*", x = -rode(8), tolerance = 0.1 }
expect { "the third start with their belt", body = "box3_*", x = rode(3), tolerance = 0.1 }
expect { "they stay upright", always = true, body = "box*", angle = {-0.02, 0.02} }
