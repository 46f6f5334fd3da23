-- crush_one.lua - discs pressed against walls by jaws until they overlap by 30 cm; the jaws leave at 1, 10 and 40 m/s.
-- Fails: stored impulses are glue: one sweep does not undo what the press has stored, and the disc leaves at the jaw's
-- speed. Right: a jaw that leaves pulls nothing: the disc parts from the wall no faster than overlap is undone.
scene { title = "Jaws that leave", gravity = {0, 0}, duration = 3 }
local overlap = param("overlap", 0.3, 0, 0.9)
local worst, was = { 0, 0, 0 }, {}
for k, v in ipairs { 1, 10, 40 } do
    body { type = "static", box { 1, 3 }, at = {-1, 4 * k} }
    local jaw = body { name = "jaw" .. k, type = "kinematic", box { 1, 3 }, at = {1.5, 4 * k} }
    body { name = "disc" .. k, circle { 0.5 }, at = {0, 4 * k} }
    jaw:set_velocity(-0.5 - overlap, 0)
    at(1, function() jaw:set_velocity(0, 0) end)
    at(1.3, function() jaw:set_velocity(v, 0) end)
    expect { ("a jaw that leaves at %g m/s pulls nothing"):format(v), test = function()
        return worst[k] <= 6.6, worst[k], 6.6
    end }
    expect { ("the disc stays with its wall, jaw at %g m/s"):format(v), at = 1.8, body = "disc" .. k, x = {-0.1, 0.6} }
end
every_step(function(t)
    for k = 1, 3 do
        local x = find("disc" .. k):position()
        if was[k] and t > 1.3 then worst[k] = math.max(worst[k], math.abs(x - was[k]) * 60) end
        was[k] = x
    end
end)
