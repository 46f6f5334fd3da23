-- body_type.lua - a platform that moves to and fro becomes dynamic, then static, then kinematic again, with a crate on it.
-- Moved, it carries the crate; dynamic, it falls onto its supports; static, it stands.
scene { title = "Body types", duration = 8 }
camera { fit = {{-7, -1}, {7, 5}}, at = 1.5 }
body { type = "static", box { 40, 1 }, at = {0, -0.5} }
body { type = "static", box { 0.5, 1, at = {-2, 0.5} }, box { 0.5, 1, at = {2, 0.5} }, color = "#8792a2" }
local deck = body { name = "deck", type = "kinematic", box { 6, 0.4 }, at = {0, 2.2}, density = 50, color = 1 }
body { name = "crate", box { 0.8, 0.8 }, at = {0, 2.8}, density = 20, color = 2 }
every_step(function(t) -- to and fro with at most 2 m/s^2: less than friction can give
    if t < 2 then deck:set_velocity(0.63 * math.sin(math.pi * t), 0) end
end)
at(2, function() deck:set_velocity(0, 0) deck:set_type("dynamic") end)
at(5, function() deck:set_type("static") end)
at(6, function() deck:set_type("kinematic"); deck:set_velocity(0, 0) end)
at(6.5, function() deck:move_to(0, 2.2, 0, 1) end)
expect { "it carries the crate", from = 0, till = 2, test = function()
    local off = math.abs(find("crate"):position() - deck:position())
    return off < 0.02, off, 0.02
end }
expect { "kinematic, it ignores gravity", from = 0, till = 1.95, body = "deck", y = 2.2, tolerance = 1e-4 }
expect { "dynamic, it rests on the supports", at = 4.9, body = "deck", y = 1.2, angle = {-0.01, 0.01}, tolerance = 0.02 }
expect { "the crate rests on it", at = 4.9, body = "crate", y = 1.8, tolerance = 0.03 }
expect { "static, it stands", from = 5, till = 6, body = "deck", y = 1.2, tolerance = 0.02 }
expect { "kinematic again, it lifts the crate", at = 7.9, body = "crate", y = 2.8, tolerance = 0.03 }
