-- one_way_stack.lua - a stack stands on a one-way platform, a ball is thrown up through it; a platform that rises under
-- another stack. Fails: what passes a platform lifts or pulls what stands on it. Right: the stacks stand.
scene { title = "Stacks on one-way platforms", duration = 5 }
local wood = material { density = 600, friction = 0.6 }
body { type = "static", box { 60, 1 }, at = {0, -0.5}, material = wood }
body { name = "plank", type = "static", box { 6, 0.2 }, at = {-5, 3}, one_way = {0, 1}, material = wood }
local lift = body { name = "lift", type = "kinematic", box { 6, 0.2 }, at = {5, 1}, one_way = {0, 1}, material = wood }
for i = 1, 5 do
    body { name = "a" .. i, box { 1, 1 }, at = {-5, 2.6 + i}, material = wood }
    body { name = "lifted" .. i, box { 1, 1 }, at = {5, 0.6 + i}, material = wood }
end
local ball = body { name = "ball", circle { 0.3 }, at = {-3, 0.31}, velocity = {0, 12} }
at(1, function() lift:set_velocity(0, 1) end)
at(3, function() lift:set_velocity(0, 0) end)
local highest = 0
every_step(function() highest = math.max(highest, select(2, ball:position())) end)
expect { "the ball went through", test = function() return highest > 6, highest, 6 end }
expect { "the ball came to lie on the plank", body = "ball", y = {3.38, 3.41} }
expect { "the stack on the plank stands", always = true, body = "a*", x = {-5.02, -4.98}, angle = {-0.02, 0.02} }
expect { "the stack on the lift stands", always = true, body = "lifted*", x = {4.98, 5.02}, angle = {-0.02, 0.02} }
expect { "the top of it is two metres higher", body = "lifted5", y = {7.55, 7.61} }
