-- seesaw_heavy.lua - a heavy ball falls on one end of a seesaw on whose other end a light one lies.
-- Fails: e = 0 through a lever gives the light one more than the lever can. Right: at e = 0 the ends of a massless plank
-- move alike: the light one leaves at the heavy one's speed at most, so it rises by what the heavy one falls at most.
scene { title = "Seesaw", duration = 4 }
local ratio, fall = param("ratio", 1000, 1, 1e6), param("fall", 2, 0.1, 20)
body { type = "static", box { 60, 1 }, at = {0, -0.5} }
local plank = body { name = "plank", box { 6, 0.1 }, at = {0, 1}, mass = 1 }
revolute { plank, at = {0, 1}, limits = {-0.3, 0.3} }
body { name = "light", box { 0.3, 0.3 }, at = {-2.7, 1.2}, mass = 1 }
body { name = "heavy", circle { 0.3 }, at = {2.7, 1.35 + fall}, mass = ratio }
local highest = 0
every_step(function() highest = math.max(highest, select(2, find("light"):position())) end)
expect { "the light one rises as far as the heavy one falls at most", test = function()
    local most = 1.2 + fall + 2 * 2.7 * math.sin(0.3) + 0.02 -- the way on the plank counts twice: fallen, and risen
    return highest <= most, highest, most
end }
expect { "it is thrown at all", test = function() return highest > 1.5, highest, 1.5 end }
expect { "the plank keeps its axle", always = true, max_joint_error = 0.05 }
expect { "the stops hold within a degree in the end", body = "plank", angle = {-0.3175, 0.3175} }
