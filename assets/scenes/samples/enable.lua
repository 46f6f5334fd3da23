-- enable.lua - bodies are taken out of the simulation and put in again: a shelf that is disabled lets its crate fall; a pendulum
-- that is disabled in mid-swing stays in the air, and swings on afterwards; its hinge still holds.
scene { title = "Enable and disable", duration = 6 }
camera { fit = {{-6, -4}, {6, 4}}, at = 2.5 }
body { type = "static", box { 20, 1 }, at = {0, -3.5} }
local shelf = body { name = "shelf", type = "static", box { 3, 0.3 }, at = {-3, 1}, color = "#c08a4a" }
body { name = "crate", box { 1, 1 }, at = {-3, 1.65}, color = 1 }
local bob = body { name = "bob", circle { 0.4 }, at = {5, 3}, color = 2 }
revolute { bob, at = {3, 3}, name = "hinge" }
at(1, function() bob:set_enabled(false) end)
at(2, function() shelf:set_enabled(false) end)
at(3, function() bob:set_enabled(true) end)
local stood = {}
every_step(function(t) if t > 1 and t < 3 then stood = stood.x and stood or { x = bob:position() } end end)
expect { "the shelf bears the crate", at = 1.9, body = "crate", y = 1.65, tolerance = 0.01 }
expect { "disabled, it does not", at = 3.5, body = "crate", y = -2.5, tolerance = 0.01 }
expect { "a disabled pendulum stays in the air", at = 2.9, test = function()
    local off = math.abs(bob:position() - stood.x) return off < 1e-5, off, 1e-5
end }
expect { "enabled, it swings on", from = 3, till = 6, test = function()
    local x, y = bob:position()
    local off = math.abs(math.sqrt((x - 3) * (x - 3) + (y - 3) * (y - 3)) - 2) return off < 0.01, off, 0.01
end }
expect { "it moves again", at = 3.5, test = function() return bob:speed() > 0.1, bob:speed(), 0.1 end }
