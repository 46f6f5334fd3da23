-- far_ragdolls.lua - stacks and dolls of six parts fall onto their ground 20 km from the origin, beside the same at the origin. Both
-- come to rest alike: within what floats can tell of places there, 2 mm.
scene { title = "Far away", duration = 6 }
camera { fit = {{-6, -1}, {6, 7}}, at = 1 }
local function build(where, x0)
    body { type = "static", box { 12, 1 }, at = {x0, -0.5} }
    for i = 1, 6 do body { name = where .. "box" .. i, box { 0.8, 0.8 }, at = {x0 - 3, 0.8 * i - 0.4}, color = 1 } end
    local last
    for i = 1, 6 do
        local limb = body { name = where .. "limb" .. i, capsule { 0.5, 0.15 }, at = {x0 + 0.5 * i, 3 + 0.25 * i}, angle_deg = 27, apart = where, color = 2 }
        if last then revolute { last, limb, at = {x0 + 0.5 * i - 0.25, 3 + 0.25 * i - 0.125}, limits = {-1, 1}, motor = { speed = 0, torque = 0.2 } } end
        last = limb
    end
end
build("near ", 0)
build("far ", 20000)
for _, where in ipairs { "near ", "far " } do
    expect { where .. "stack stands", body = where .. "box6", y = 4.4, angle = {-0.01, 0.01}, tolerance = 0.02 }
    expect { where .. "doll lies on the ground", body = where .. "limb*", y = {0.13, 0.6} }
end
expect { "joints hold", always = true, max_joint_error = 0.05 }
expect { "all lie still", from = 5, max_speed = 0.1, max_penetration = 0.01 }
