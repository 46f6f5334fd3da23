-- locks.lua - seven boxes fall onto a ledge, each with other axes locked: none, x, y, rotation, and pairs of them. What
-- is locked does not move by a hair, however the box is hit.
scene { title = "Motion locks", duration = 4 }
camera { fit = {{-2, -1.5}, {15, 5}}, at = 0.9 }
body { type = "static", box { 60, 1 }, at = {0, -1.5} }
local locks = { {}, {"x"}, {"y"}, {"rotation"}, {"x", "rotation"}, {"x", "y"}, {"y", "rotation"} }
for k, lock in ipairs(locks) do
    local x = 2.2 * (k - 1)
    body { type = "static", box { 0.8, 0.4 }, at = {x - 0.5, 0}, color = "#8792a2" }
    local it = body { name = "box" .. k, box { 1, 1 }, at = {x, 2}, color = k, lock = lock, label = table.concat(lock, " ") }
    at(2, function() it:apply_impulse(1, 0.5, x, 2.4) end)
    for _, axis in ipairs(lock) do
        if axis == "x" then expect { ("box %d keeps x"):format(k), always = true, body = "box" .. k, x = x, tolerance = 1e-6 } end
        if axis == "y" then expect { ("box %d keeps y"):format(k), always = true, body = "box" .. k, y = 2, tolerance = 1e-6 } end
        if axis == "rotation" then expect { ("box %d does not turn"):format(k), always = true, body = "box" .. k, angle = 0, tolerance = 1e-6 } end
    end
end
expect { "free, it tips off its ledge", at = 1.9, body = "box1", y = {-0.6, -0.4} }
-- Turning, its corner would slide by; friction beyond 0.1 / 0.5, the arms of the two forces, forbids it.
expect { "locked in x it would tip, but is jammed by friction", at = 1.9, body = "box2", angle = {-0.02, 0.02}, y = {0.69, 0.71} }
expect { "locked in rotation it stands on the ledge", at = 1.9, body = "box4", y = 0.7, tolerance = 0.01 }
expect { "locked in x and rotation, too", body = "box5", y = 0.7, tolerance = 0.01 }
expect { "locked in y alone it flies off where it was struck", body = "box3", x = {2 * 2.2 + 0.5, 20} }
expect { "locked in x and y it spins on the spot", body = "box6", spin = {-20, -0.5} }
