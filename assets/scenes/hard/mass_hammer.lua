-- mass_hammer.lua - a hammer of 10,000 kg beats ten times on a nail of 1 kg that stands in a tight groove on the ground.
-- Fails: each blow leaves the nail deeper in the ground, or throws it out. Right: the nail is as long as it was.
scene { title = "Hammer and nail", duration = 10 }
local ratio = param("ratio", 10000, 1, 1e6)
body { type = "static", box { 20, 1, at = {0, -0.5} }, box { 1, 0.5, at = {-0.56, 0.25} }, box { 1, 0.5, at = {0.56, 0.25} } }
body { name = "nail", box { 0.1, 1 }, at = {0, 0.5}, mass = 1 }
local hammer = body { name = "hammer", box { 1, 1 }, at = {0, 1.8}, mass = ratio }
local rail = prismatic { world, hammer, axis = {0, 1} }
-- It is lifted for 0.6 s and let go for 0.4 s.
every(1, function() rail:set_motor(0.7, ratio * 20) end)
for i = 1, 9 do at(i + 0.6, function() rail:set_motor() end) end
expect { "the nail stays whole in its groove", always = true, body = "nail", y = {0.48, 0.52}, x = {-0.02, 0.02} }
expect { "the hammer never beats through", always = true, body = "hammer", y = {1.45, 2.2} }
