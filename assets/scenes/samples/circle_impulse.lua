-- circle_impulse.lua - what a contact tells of its blow: discs of 1 to 4 kg fall 1.25 m onto the ground with e = 0, 0.5 and 1. The
-- impulse told is m (1 + e) sqrt(2 g h), at the moment sqrt(2 h / g), between the steps.
scene { title = "Impulse of a blow", duration = 1 }
camera { fit = {{-1, -0.6}, {6, 2.4}}, at = 0.7, trail = 0.4 }
body { type = "static", box { 20, 1 }, at = {2, -0.5} }
local h, told = 1.25, {}
for k, case in ipairs { {1, 0}, {2, 0.5}, {4, 1} } do
    local m, e, name = case[1], case[2], "disc" .. k
    body { name = name, circle { 0.3 }, at = {2.5 * (k - 1), h + 0.3}, mass = m, material = material { restitution = e }, color = k }
    local v, t = math.sqrt(2 * 9.81 * h), math.sqrt(2 * h / 9.81)
    expect { ("disc %d: the impulse is m (1 + e) v"):format(k), test = function()
        local it = told[name] or { impulse = 0 }
        return math.abs(it.impulse / (m * (1 + e) * v) - 1) < 0.03, it.impulse, m * (1 + e) * v
    end }
    expect { ("disc %d: the speed is v"):format(k), test = function()
        local it = told[name] or { speed = 0 } return math.abs(it.speed / v - 1) < 0.03, it.speed, v
    end }
    expect { ("disc %d: the moment is sqrt(2 h / g)"):format(k), test = function()
        local it = told[name] or { time = 0 } return math.abs(it.time - t) < 0.017, it.time, t
    end }
end
on_hit { a = "disc*", function(disc, _, c)
    told[disc:name()] = told[disc:name()] or { impulse = c.impulse, speed = c.speed, time = c.time }
end }
