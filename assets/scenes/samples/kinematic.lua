-- kinematic.lua - a body is driven along an ellipse by its targets and turns as it goes; it follows whatever is in its
-- way, pushes crates aside and is not pushed itself.
scene { title = "Kinematic", duration = 8 }
camera { fit = {{-6, -1}, {8, 7}}, at = 2.9, trail = 2 }
local a, b, period = 3, 2, 4
body { type = "static", box { 40, 1 }, at = {0, -0.5} }
local driven = body { name = "driven", type = "kinematic", box { 0.4, 2 }, at = {a, 2.9}, color = 1 }
for i = 1, 4 do body { name = "crate" .. i, box { 0.6, 0.6 }, at = {0.5 + 0.7 * i, 0.3}, color = 2 } end
local function place(t)
    local w = 2 * math.pi * t / period
    return a * math.cos(w), 2.9 + b * math.sin(w), w / 2
end
every_step(function(t) driven:move_to(place(t + 1 / 60)) end)
exact { "its way", body = "driven", x = function(t) return (place(t)) end, y = function(t) return (select(2, place(t))) end }
expect { "it follows the ellipse", exact = "its way", tolerance = 1e-3 }
expect { "it turns with it", from = 0.1, test = function()
    local _, _, angle = place(time())
    local off = math.abs(math.sin((driven:angle() - angle) / 2))
    return off < 1e-3, off, 1e-3
end }
expect { "it has pushed a crate", test = function()
    local most = 0
    for i = 1, 4 do most = math.max(most, math.abs(find("crate" .. i):position() - (0.5 + 0.7 * i))) end
    return most > 0.3, most, 0.3
end }
expect { "no crate is pressed into the ground", always = true, body = "crate*", y = {0.28, 12} }
