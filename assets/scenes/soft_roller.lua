-- soft_roller.lua - a soft creature rolls past a flag by shifting the weight in its middle; its twin does the same on ice, in vain.
-- Shows: balloon{} held by bodies in its skin, springs to a heart in its middle as muscles, whose rest a handler changes. What a creature
-- does to itself does not move it: where it gets, friction with the ground brings it.
scene { title = "Soft roller", duration = 12, description = "It holds its heart ahead of where it stands, and rolls; on ice that is no use." }
camera { fit = {{-2.4, -2.6}, {5.6, 1.8}}, at = 7 }
local R, reach, speed, begin, muscle_count = 0.5, 0.1, 0.7, 1, 8 -- [m], [m] that the heart is held ahead, [m/s] wanted, [s]

local function creature(name, y0, friction, color)
    body { name = name, label = " ", type = "static", box { 9, 0.2, at = {1.6, y0 - 0.1} }, material = material { friction = friction },
           color = friction > 0 and "#a58a5f" or "#bfe0ee" }
    local skin = balloon { at = {-1, y0 + R + 0.02}, radius = R, nodes = 40, mass = 2, pressure = 400, ambient = 2e3,
                           stiffness = 8e3, damping = 20, bending = 0.3,
                           friction = 0.8, color = color }
    local heart = body { name = name .. " heart", label = " ", circle { 0.13 }, at = {-1, y0 + R + 0.02}, mass = 6, collides = {}, color = "#c0395a" }
    local muscles, ahead = {}, 0
    for i = 1, muscle_count do
        local node = 1 + (i - 1) * 40 // muscle_count
        local x, y = skin:node(node)
        local bone = body { label = " ", circle { 0.03 }, at = {x, y}, mass = 0.2, collides = {}, color = "#5b4636" }
        skin:hold(node, 0, 0, bone)
        muscles[i] = { bone = bone, joint = distance { heart, bone, spring = { stiffness = 1500, damper = 20 } } }
    end
    -- Muscles ahead are shortened, those behind let go, the more the slower it is: the heart hangs ahead, and its weight rolls the skin.
    every_step(function(t)
        if t < begin then return end
        local now = skin:measure()
        local mean = (now.momentum_x + heart:mass() * heart:velocity()) / (now.mass + heart:mass())
        local wanted = reach * math.max(-1, math.min(1, (speed - mean) / speed))
        ahead = ahead + (wanted - ahead) / 30 -- it takes half a second
        for _, m in ipairs(muscles) do
            local x, y = m.bone:position()
            local way = math.sqrt((x - now.x) ^ 2 + (y - now.y) ^ 2)
            m.joint:set_rest(math.max(0.05, R - ahead * (x - now.x) / way))
        end
    end)
    -- Where all of it is, on the mean: x.
    return skin, function()
        local now = skin:measure()
        local sum, mass = now.x * now.mass + heart:position() * heart:mass(), now.mass + heart:mass()
        for _, m in ipairs(muscles) do sum, mass = sum + m.bone:position() * m.bone:mass(), mass + m.bone:mass() end
        return sum / mass
    end
end
local dry, dry_center = creature("dry", 0, 0.8, "#e39b52")
local ice, ice_center = creature("ice", -2, 0, "#7fa8d9")
body { name = "flag", label = " ", type = "static", collides = {}, color = "#c0395a", box { 0.04, 1.3, at = {4.2, 0.65} },
       polygon {{4.22, 1.3}, {4.22, 0.95}, {4.75, 1.12}} }

local farthest, back, astray = -1, 0, 0
every_step(function()
    farthest = math.max(farthest, dry_center())
    back = math.max(back, farthest - dry_center())
    astray = math.max(astray, math.abs(ice_center() + 1))
end)
-- It begins at -1 m, and slows down as it gets up to speed.
local half = -1 + 0.5 * speed * (12 - begin)
expect { "it gets on at half of the speed that it wants, or more", at = 12, test = function() return dry_center() > half, dry_center(), half end }
expect { "it goes one way", at = 12, test = function() return back < 0.01, back, 0.01 end }
expect { "on ice its centre of mass stays where it was", at = 12, test = function() return astray < 1e-3, astray, 1e-3 end }
expect { "the heart stays inside", always = true, body = "ice heart", y = {-2 + 0.3, -2 + 0.7}, x = {-1.2, -0.8} }
expect { "it stays round", always = true, test = function()
    local height = dry:measure().y
    return height > 0.9 * R and height < 1.1 * R, height, 1.1 * R
end }
