-- waterfall.lua - a stream runs down stairs and washes ragdolls into the pool below, where they float.
-- Shows: liquid{} from a spring to a drain, with bodies made of many joints in it; what comes in is what goes out and what is there.
scene { title = "Waterfall", description = "A stream washes ragdolls down the stairs into a pool.", duration = 16, seed = 3 }
camera { fit = {{-3.4, -1.6}, {12.4, 6.6}}, at = 4.2 }
local rock = material { name = "rock", density = 2500, friction = 0.3 }
local flesh = material { name = "flesh", density = 600, friction = 0.2, restitution = 0.1 }

-- A river bed on top, stairs, a pool of 1.4 m with a wall behind it.
local steps, depth, height = 5, 0.9, 0.8
local ground = { {-3.2, -1.8}, {12.2, -1.8}, {12.2, 1.4}, {11.6, 1.4}, {11.6, -1.4}, {1 + steps * depth, -1.4} }
for i = 0, steps - 1 do
    ground[#ground + 1] = { 1 + (steps - i) * depth, i * height }
    ground[#ground + 1] = { 1 + (steps - i - 1) * depth, i * height }
end
ground[#ground + 1] = { 1, steps * height }
for _, p in ipairs { {-2.6, steps * height + 0.3}, {-2.6, 6}, {-3.2, 6} } do ground[#ground + 1] = p end
body { name = "rock", type = "static", outline(ground), material = rock }

-- A doll that looks to the right, its hips at (x, y); limits in degrees, positive counter-clockwise.
local function ragdoll(name, x, y, color)
    local function limb(part, length, radius, ly)
        return body { name = name .. "_" .. part, label = "", capsule { length, radius }, at = {x, y + ly}, angle_deg = 90,
                      material = flesh, apart = name, color = color }
    end
    local function hang(a, b, part, jy, lower, upper)
        revolute { a, b, at = {x, y + jy}, limits = { radians(lower), radians(upper) }, name = name .. "_" .. part,
                   motor = { speed = 0, torque = 20 } }
    end
    local chest = limb("chest", 0.4, 0.2, 0.36)
    local head = body { name = name .. "_head", circle { 0.19 }, at = {x, y + 0.96}, material = flesh, apart = name, color = color }
    hang(chest, head, "neck", 0.77, -40, 40)
    for _, side in ipairs { "left", "right" } do
        local arm, thigh, shin = limb(side .. "_arm", 0.56, 0.1, 0.3), limb(side .. "_thigh", 0.44, 0.13, -0.24), limb(side .. "_shin", 0.44, 0.11, -0.72)
        hang(chest, arm, side .. "_shoulder", 0.56, -120, 160)
        hang(chest, thigh, side .. "_hip", 0.02, -25, 110)
        hang(thigh, shin, side .. "_knee", -0.48, -130, 0)
    end
end
local dolls = 3
for i = 1, dolls do ragdoll("doll" .. i, -1.6 + 0.9 * (i - 1), steps * height + 1.32, i - 1) end

local spacing = param("spacing", 0.06, 0.05, 0.12)
liquid { spacing = spacing, box { 11.6 - 1 - steps * depth, 1.4, at = {(12.6 + steps * depth) / 2, -0.7} } }
local drained = 0
every_step(function(t)
    if t < 11 then liquid { box { 0.4, 1, at = {-2.4, steps * height + 0.8} }, velocity = {3, 0}, refill = true } end
    drained = drained + liquid_drain(11, 0.1, 11.6, 3)
end)

local wet = {}
on_wet { a = "doll*", function(part) wet[part:name()] = true end }

expect { "nothing leaves but through the drain", always = true, test = function()
    return liquid_in(-2.62, -1.42, 11.62, 99) == liquid_in(-99, -99, 99, 99)
end }
expect { "every part of every doll gets wet", at = 16, test = function()
    local count = 0
    for _ in pairs(wet) do count = count + 1 end
    return count == 8 * dolls, count, 8 * dolls
end }
expect { "the dolls are in the pool", at = 16, body = "doll*", x = {1 + steps * depth, 11.6}, y = {-1.4, 1.2} }
-- Six tenths of the water's density: their heads, or what else comes up, look out.
expect { "they float", at = 16, test = function()
    local low = 9
    for i = 1, dolls do
        local top = -9
        for _, part in ipairs { "chest", "head", "left_arm", "right_arm", "left_shin", "right_shin" } do
            top = math.max(top, select(2, find("doll" .. i .. "_" .. part):position()))
        end
        low = math.min(low, top)
    end
    return low > -0.3, low, -0.3
end }
expect { "they hold together", always = true, max_joint_error = 0.2 }
expect { "water comes down all the time", from = 5, till = 11, test = function()
    local area = liquid_in(1, 0, 1 + steps * depth, 5)
    return area > 0.05, area, 0.05
end }
