local n = param("n", 3, 1, 10)
body{ name = "floor", type = "static", box{10, 1}, at = {0, -0.5} }
local b = body{ name = "ball", circle{0.5}, at = {0, 0.51}, velocity = {0, -5} }
at(0, function(t) text("t " .. t) b:apply_impulse(1, 0) end)
every(0.02, function() score("n", score("n") + 1) end)
every_step(function() b:set_velocity(1, -9) end)
on_contact{ a = "ball", function(a, o, c) a:destroy() body{ box{1, 1}, at = {c.x, 9} } end }
on_end(function() finish() end)
expect{ "t", always = true, test = function() return energy() >= 0, penetration() end }
exact{ body = "ball", x = function(t) return t end }
