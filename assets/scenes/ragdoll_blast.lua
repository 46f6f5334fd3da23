-- ragdoll_blast.lua - a bomb goes off among puppets that hang on strings.
-- Shows: blast{} on bodies made of joints, its falloff and what shields from it; strings (distance joints
-- with limits) that tear at a force; a hanging doll whose string carries m g.
scene { title = "Ragdoll blast", description = "What sees the bomb flies; the puppet behind the wall hangs still.",
        duration = 12, seed = 5 }
camera { fit = {{-6.6, -0.5}, {6.6, 5.2}}, at = 1.15, trail = 0.15 }

local fuse = 1             -- [s] until the bang
local string_holds = 2000  -- [N]
local wood = material { name = "wood", density = 400, friction = 0.6, restitution = 0.1 }
local stone = material { name = "stone", friction = 0.7 }
local cloth = material { name = "cloth", density = 60, friction = 0.5, restitution = 0.1 }

body { name = "floor", type = "static", box { 40, 1 }, at = {0, -0.5}, material = stone }
body { name = "bar", type = "static", box { 13, 0.16 }, at = {0, 4.8}, material = stone }
for side = -1, 1, 2 do
    body { name = side < 0 and "post_left" or "post_right", type = "static", box { 0.3, 4.72 }, at = {6.35 * side, 2.36}, material = stone }
end
body { name = "wall", type = "static", box { 0.3, 4.1 }, at = {4.3, 2.05}, material = stone }

-- A puppet that looks to the right, its hips at (x, y), its head on a string from the bar. The limits of
-- its joints are in degrees, positive counter-clockwise; the motors that stand still are stiffness.
local function puppet(name, x, y, color)
    local function limb(part, length, radius, ly)
        return body { name = name .. "_" .. part, capsule { length, radius }, at = {x, y + ly}, angle_deg = 90,
                      material = cloth, apart = name, color = color }
    end
    local function hang(a, b, part, jy, lower, upper)
        revolute { a, b, at = {x, y + jy}, limits = { radians(lower), radians(upper) }, name = name .. "_" .. part,
                   motor = { speed = 0, torque = 1.5 } }
    end
    local chest = limb("chest", 0.34, 0.15, 0.28)
    local head = body { name = name .. "_head", circle { 0.15 }, at = {x, y + 0.78}, material = cloth,
                        apart = name, color = color }
    hang(chest, head, "neck", 0.62, -40, 40)
    for _, side in ipairs { "left", "right" } do
        local upper_arm = limb(side .. "_upper_arm", 0.26, 0.06, 0.32)
        local forearm = limb(side .. "_forearm", 0.26, 0.05, 0.02)
        hang(chest, upper_arm, side .. "_shoulder", 0.46, -120, 160)
        hang(upper_arm, forearm, side .. "_elbow", 0.17, 0, 130)
        local thigh = limb(side .. "_thigh", 0.36, 0.08, -0.2)
        local shin = limb(side .. "_shin", 0.36, 0.07, -0.62)
        hang(chest, thigh, side .. "_hip", 0.02, -25, 110)
        hang(thigh, shin, side .. "_knee", -0.41, -130, 0)
    end
    local top = y + 0.93
    distance { "bar", head, at_a = {x, 4.72}, at_b = {x, top}, limits = { 0, 4.72 - top }, name = "string_" .. name,
               break_force = string_holds }
end

puppet("near_left", -1.6, 1.8, 0)
puppet("near_right", 1.6, 1.8, 1)
puppet("far_left", -3.9, 2.2, 2)
puppet("far_right", 3.2, 2.2, 3)
puppet("hidden", 5.4, 1.8, 4)

-- The bomb lies on a crate.
body { name = "crate", box { 1.2, 0.8 }, at = {0, 0.4}, material = wood, color = 5 }
body { name = "bomb", circle { 0.28 }, at = {0, 1.08}, material = wood, color = 8, label = "bomb" }
at(fuse, function()
    local x, y = find("bomb"):position()
    find("bomb"):destroy()
    blast { at = {x, y}, radius = 1, falloff = 3.6, impulse = 210, occlusion = "walls" }
end)

-- A puppet's mass, by the areas of its limbs: its string carries that times g.
local function area(length, radius) return 2 * radius * length + math.pi * radius^2 end
local mass = 60 * (math.pi * 0.15^2 + area(0.34, 0.15) +
                   2 * (area(0.26, 0.06) + area(0.26, 0.05) + area(0.36, 0.08) + area(0.36, 0.07)))
expect { "every string carries its puppet", from = 0.5, till = fuse - 0.05, joint = "string_*",
         reaction = { mass * 9.81 * 0.995, mass * 9.81 * 1.005 } }
expect { "nobody moves before the bang", from = 0.3, till = fuse - 0.05, max_speed = 0.05 }
expect { "the near ones fly to the left", at = fuse + 0.15, body = "near_left_chest", vx = {-30, -3} }
expect { "and to the right", at = fuse + 0.15, body = "near_right_chest", x = {2.2, 4.2} }
expect { "four strings tear", joint = "string_*", broken = 4 }
expect { "the puppet behind the wall hangs still", from = 0.3, body = "hidden_*", x = {5.39, 5.41}, max_speed = 0.01 }
for _, name in ipairs { "near_left", "near_right", "far_left", "far_right" } do
    expect { name .. " lies on the floor", body = name .. "_*", x = {-6.3, 4.3}, y = {0, 1.3}, max_speed = 0.3 }
end
expect { "the puppets hold together", always = true, max_joint_error = 0.35 }
