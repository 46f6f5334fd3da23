-- crush_release.lua - a jaw closes on three discs until they are pressed to half, then opens (kinematic: it has any force).
-- Fails: what was pressed together flies: 30 m/s here. Right: it opens gently and stays in the jaw's mouth.
scene { title = "Crush and release", gravity = {0, 0}, duration = 5 }
local squeeze = param("squeeze", 0.5, 0, 0.9)
local left = body { name = "left", type = "kinematic", box { 1, 3 }, at = {-2, 0} }
local right = body { name = "right", type = "kinematic", box { 1, 3 }, at = {2, 0} }
local was, worst = {}, 0
for i = -1, 1 do body { name = "disc" .. i + 2, circle { 0.5 }, at = {i, 0} } end
local close = 1.5 * squeeze
at(0.2, function() left:set_velocity(close, 0) right:set_velocity(-close, 0) end)
at(1.2, function() left:set_velocity(0, 0) right:set_velocity(0, 0) end)
at(2.2, function() left:set_velocity(-10, 0) right:set_velocity(10, 0) end)
every_step(function(t)
    for i = 1, 3 do
        local x, y = find("disc" .. i):position()
        if was[i] and t > 2.2 then worst = math.max(worst, math.abs(x - was[i][1]) * 60, math.abs(y - was[i][2]) * 60) end
        was[i] = {x, y}
    end
end)
expect { "nothing flies when it opens", test = function() return worst <= 6.01, worst, 6.01 end }
expect { "nothing has gone far", body = "disc*", x = {-4, 4}, y = {-4, 4} }
