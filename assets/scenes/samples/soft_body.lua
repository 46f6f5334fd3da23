-- soft_body.lua - two rings of capsules that springy welds hold together fall on one another. They are squeezed and spring back:
-- no weld opens, and in the end each ring is as round as its weight lets it.
scene { title = "Soft bodies", duration = 10 }
camera { fit = {{-6, -1}, {6, 8}}, at = 1.35 }
body { type = "static", box { 30, 1, at = {0, -0.5} }, box { 1, 6, at = {-5.5, 3} }, box { 1, 6, at = {5.5, 3} } }
local n, R = 24, 1.2
local function ring(name, x, y, color)
    local links, length = {}, 2 * R * math.sin(math.pi / n)
    for i = 1, n do
        local a = 2 * math.pi * i / n
        links[i] = body { name = name .. i, capsule { length, 0.15 }, at = {x + R * math.cos(a), y + R * math.sin(a)}, angle = a + math.pi / 2, density = 1, damping = 0.3, color = color }
    end
    for i = 1, n do
        local a = 2 * math.pi * (i + 0.5) / n
        weld { links[i], links[i % n + 1], at = {x + R * math.cos(a), y + R * math.sin(a)}, spring = { stiffness = 40, damper = 1 } }
    end
    local function width() -- the least and largest diameter
        local least, most = 100, 0
        for i = 1, n // 2 do
            local ax, ay = links[i]:position()
            local bx, by = links[i + n // 2]:position()
            local d = math.sqrt((ax - bx) * (ax - bx) + (ay - by) * (ay - by))
            least, most = math.min(least, d), math.max(most, d)
        end
        return least, most
    end
    local squeezed = 100
    every_step(function() squeezed = math.min(squeezed, (width())) end)
    expect { ("ring %s is squeezed"):format(name), test = function() return squeezed < 0.97 * 2 * R, squeezed, 0.97 * 2 * R end }
    expect { ("ring %s is round again"):format(name), test = function()
        local least, most = width() return least > 0.7 * 2 * R and most < 1.3 * 2 * R, least / (2 * R), 0.7
    end }
end
ring("a", 0, 1.5, 1)
ring("b", 0.4, 5, 2)
expect { "no weld opens", always = true, max_joint_error = 0.1 }
expect { "nobody is pressed into the ground", always = true, body = "a*", y = {0.1, 6} }
expect { "they come to rest", max_speed = 0.1 }
