-- wheel.lua - struts: three wheels hang from a beam by springs and sag by m g / k; one is driven and turns at what its motor
-- says; the stop of one that is too soft catches it.
scene { title = "Wheel joints", duration = 5 }
camera { fit = {{-5, -3}, {5, 2}}, at = 0.5, trail = 0.5 }
local beam = body { name = "beam", type = "static", box { 9, 0.3 }, at = {0, 1}, color = "#8792a2" }
local m, k = 5, { 500, 500, 20 }
for i = 1, 3 do
    local x = 3 * (i - 2)
    local tyre = body { name = "wheel" .. i, circle { 0.5 }, at = {x, 0}, mass = m, color = i, collides = {} }
    wheel { beam, tyre, at = {x, 0}, axis = {0, 1}, name = "strut" .. i, spring = { stiffness = k[i], damper = 40 },
            limits = i == 3 and {-1, 1} or nil, motor = i == 2 and { speed = 6, torque = 20 } or nil }
end
for i = 1, 2 do
    expect { ("strut %d sags by m g / k"):format(i), from = 4, body = "wheel" .. i, y = -m * 9.81 / k[i], tolerance = 0.002 }
end
expect { "the soft one is caught by its stop", from = 4, body = "wheel3", y = -1, tolerance = 0.01 }
expect { "the motor turns its wheel", from = 1, body = "wheel2", spin = 6, tolerance = 0.01 }
expect { "the others do not turn", always = true, body = "wheel1", spin = 0, tolerance = 1e-3 }
expect { "struts hold", always = true, max_joint_error = 0.005 }
