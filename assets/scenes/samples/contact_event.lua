-- contact_event.lua - a ship without gravity picks up what it touches: each piece of debris is welded to it where it touched, at the
-- moment of its contact. Momentum is kept: in the end all drift as one body with what all had in the beginning.
scene { title = "Picked up by contact", gravity = {0, 0}, duration = 6, seed = 4 }
camera { fit = {{-9, -5}, {9, 5}}, at = 2, trail = 1 }
local ship = body { name = "ship", polygon { {1, 0}, {-0.6, 0.6}, {-0.6, -0.6} }, at = {-8, 0}, velocity = {5, 0}, density = 2, color = 1 }
for i = 1, 8 do
    body { name = "debris" .. i, i % 2 == 0 and circle { 0.3 } or box { 0.5, 0.5 }, at = {-5 + 1.5 * i, random(-0.1, 0.1)}, color = 2 }
end
local held = 0
ship.user.held = true
on_contact(function(a, b)
    if a.user.held ~= b.user.held then
        a.user.held, b.user.held = true, true
        held = held + 1
        weld { a, b }
    end
end)
local m, total = ship:mass(), ship:mass()
for i = 1, 8 do total = total + find("debris" .. i):mass() end
expect { "it picks up all", test = function() return held == 8, held, 8 end }
expect { "momentum is kept", always = true, momentum_drift = 0.01 }
expect { "the last one drifts with the rest", test = function()
    local px = momentum()
    return math.abs(px - m * 5) < 0.02 * m * 5, px, m * 5
end }
expect { "welds hold", always = true, max_joint_error = 0.2 }
