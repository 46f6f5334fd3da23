-- sensors.lua - what sensors see: a still one and a moving one see who comes and goes, static bodies too; each entry has its
-- leave, also when the visitor is destroyed, disabled or carried off. A bullet at 300 m/s is through a film 5 cm thin within a step, which no
-- sensor sees: a cast along its way does.
scene { title = "Sensors", duration = 6, gravity = {0, 0} }
camera { fit = {{-9, -5}, {9, 5}}, at = 0.8, trail = 0.5 }
local gate = body { name = "gate", type = "static", sensor = true, box { 2, 8 }, color = "#74b083" }
local film = body { name = "film", type = "static", sensor = true, box { 0.05, 8 }, at = {6, 0}, color = "#cf6e73" }
local sweep = body { name = "sweep", type = "kinematic", sensor = true, box { 0.5, 0.5 }, at = {-6, -4.5}, velocity = {3, 0}, color = "#e9ca6b" }
body { name = "post", type = "static", box { 0.5, 0.5 }, at = {-3, -4.5}, color = "#8792a2" }
for i, how in ipairs { "through", "destroyed", "disabled", "moved" } do
    body { name = how, circle { 0.3 }, at = {-4, 4 - 1.5 * i}, velocity = {2.5, 0}, color = i, category = "visitor", ignores = "visitor" }
end
body { name = "bullet", circle { 0.05 }, at = {-8, 3.5}, velocity = {300, 0}, color = "#d64545", collides = {} }
at(1.5, function() find("destroyed"):destroy() find("disabled"):set_enabled(false) find("moved"):teleport(-8, 0) end)
local came, went = {}, {}
on_enter { a = "gate", function(_, it) came[it:name()] = (came[it:name()] or 0) + 1 end }
on_leave { a = "gate", function(_, it) went[it:name()] = (went[it:name()] or 0) + 1 end }
local bullet, was = find("bullet"), {-8, 3.5}
every_step(function()
    local x, y = bullet:position()
    local it = x > was[1] and cast { circle { 0.05 }, from = was, to = {x, y}, ignore = "bullet", sensors = true }
    if it and it:name() == "film" then score("bullets", score("bullets") + 1) end
    was = {x, y}
end)
on_enter { a = "sweep", b = "post", function() score("posts", score("posts") + 1) end }
score("bullets", 0) score("posts", 0)
expect { "all four came", at = 1.4, body = "gate", inside = 4 }
expect { "destroyed, disabled or moved, they are out", at = 1.6, body = "gate", inside = 1 }
expect { "each entry has its leave", test = function()
    local n, open = 0, 0
    for name, times in pairs(came) do
        n = n + times
        if went[name] ~= times then open = open + 1 end
    end
    return n >= 5 and open == 0, open, 0
end }
expect { "a cast sees the bullet in the film", score = "bullets", value = {1, 1} }
expect { "a moving sensor sees a static body", score = "posts", value = {1, 1} }
expect { "nobody is stopped by a sensor", body = "through", x = -4 + 2.5 * 6, tolerance = 0.01 }
