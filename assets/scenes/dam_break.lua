-- dam_break.lua - a column of water falls, runs under crates and carries them off; a stone stays.
-- Shows: liquid{}, bodies in its one system of pressures, a front that runs ahead, what floats and what does not.
scene { title = "Dam break", duration = 14, description = "Wood of a third of its density is carried off and floats; a stone lies." }
camera { fit = { {-0.6, -0.6}, {10.6, 4.4} }, at = 1.2 }
local wood = material { density = 300, friction = 0.4 }
local rock = material { density = 2500, friction = 0.5 }
body { type = "static", name = "floor", box { 10.8, 0.4, at = { 5, -0.2 } }, material = rock }
body { type = "static", box { 0.4, 10, at = { -0.2, 4.6 } }, box { 0.4, 10, at = { 10.2, 4.6 } }, material = rock } -- a drop may fly 7 m high

local crates = {}
for i = 0, 2 do
    for k = 0, 2 do
        crates[#crates + 1] = body { name = "crate" .. #crates + 1, box { 0.5, 0.5 }, at = { 6.2 + 0.55 * i, 0.25 + 0.5 * k }, material = wood, color = 1 }
    end
end
body { name = "stone", box { 0.6, 0.6 }, at = { 8.6, 0.3 }, material = rock, color = 7 }

liquid { spacing = param("spacing", 0.05, 0.04, 0.2), box { 2.4, 2.4, at = { 1.2, 1.2 } } }

local wet, splashes = {}, 0
on_wet { a = "crate*", function(crate, e)
    wet[crate:name()] = true
    splashes = splashes + 1
end }

local function inside() return liquid_in(-0.01, -0.01, 10.01, 99) == liquid_in(-99, -99, 99, 99) end
expect { "no water leaves the tank", always = true, test = inside }
expect { "the front reaches the crates", at = 1, test = function() return liquid_in(5.7, 0, 10, 9) > 0 end }
expect { "it wets every crate", at = 3, test = function()
    local count = 0
    for _ in pairs(wet) do count = count + 1 end
    return count == #crates, count, #crates
end }
expect { "in the end it stands as high as there is of it, and crates in it", at = 14, test = function()
    local height, places = 0, 0
    for x = 0.5, 9.5, 0.5 do
        local _, y = liquid_ray(x, 4, x, 0)
        if y then height, places = height + y, places + 1 end
    end
    return math.abs(height / places - 0.64) < 0.08, height / places, 0.64
end }
expect { "the stone lies on the ground", at = 14, body = "stone", y = { 0.28, 0.32 } }
expect { "no crate does", at = 14, test = function()
    local low = 9
    for _, crate in ipairs(crates) do low = math.min(low, select(2, crate:position())) end
    return low > 0.4, low, 0.4
end }
