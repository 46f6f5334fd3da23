-- gear_lift.lua - a driven cogwheel turns another of twice its size, tooth by tooth, by contact alone; by a rack joint that one
-- lifts a door of 200 kg. It turns half as fast, the other way, and the door rises at its speed times its radius.
scene { title = "Gear lift", duration = 8 }
camera { fit = {{-4, -3.2}, {9, 5}}, at = 5 }
local steel = material { friction = 0.1, density = 20 }
local function cog(name, x, teeth, color)
    local r, shapes = teeth * 0.1, {}
    shapes[1] = circle { r - 0.16, material = steel }
    local b
    local function tooth(i)
        local a = 2 * math.pi * i / teeth
        local c, s = math.cos(a), math.sin(a)
        local function at(u, w) return { c * u - s * w, s * u + c * w } end
        return polygon { at(r - 0.2, -0.15), at(r + 0.12, -0.07), at(r + 0.12, 0.07), at(r - 0.2, 0.15) }
    end
    for i = 0, teeth - 1 do shapes[#shapes + 1] = tooth(name == "small" and i or i + 0.5) end
    local def = { name = name, at = {x, 0}, material = steel, color = color, table.unpack(shapes) }
    return body(def)
end
local small, big = cog("small", 0, 10, 1), cog("big", 3.02, 20, 2)
revolute { small, at = {0, 0}, motor = { speed = -1, torque = 20000 }, name = "drive" }
local axle = revolute { big, at = {3.02, 0}, name = "axle" }
local door = body { name = "door", box { 0.5, 3 }, at = {7, -1}, mass = 200, color = 3, collides = {} }
local guide = prismatic { door, axis = {0, 1}, limits = {-0.1, 6}, name = "guide" }
gear { axle, guide, ratio = -1 }
expect { "the big one turns half as fast the other way", from = 3, test = function()
    local ratio = big:angle() and axle:value() / -find_joint("drive"):value()
    return math.abs(ratio - 0.5) < 0.03, ratio, 0.5
end }
expect { "the door rises with it", test = function()
    local off = math.abs(guide:value() - axle:value()) return off < 0.02, guide:value(), axle:value()
end }
expect { "half a metre a second", body = "door", y = -1 + 0.5 * 8, tolerance = 0.15 }
expect { "axles hold", always = true, max_joint_error = 0.05 }
expect { "teeth do not pass through one another", always = true, max_penetration = 0.05 }
