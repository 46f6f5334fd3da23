-- weeble.lua - tumblers: upright capsules with a weight in their foot. A blast knocks them about, and each gets up again.
-- One without a weight lies down.
-- Their foot is round, of radius r, and the centre of mass is below its middle: upright is the lowest place.
scene { title = "Weebles", duration = 15 }
camera { fit = {{-10, -1}, {10, 6}}, at = 1.5 }
local floor = material { friction = 0.8, rolling_resistance = 0.01 }
body { type = "static", box { 60, 1, at = {0, -0.5} }, box { 1, 4, at = {-29.5, 2} }, box { 1, 4, at = {29.5, 2} }, material = floor }
local lead = material { density = 50, friction = 0.8, rolling_resistance = 0.01 }
local shell = material { density = 1, friction = 0.8, rolling_resistance = 0.01 }
local function weeble(name, x, weight)
    body { name = name, at = {x, 0.5}, angular_damping = 0.4, color = weight and 1 or 2,
           capsule { 1, 0.5, at = {0, 0.5}, angle_deg = 90, material = shell },
           circle { 0.25, at = {0, -0.25}, material = weight or shell } }
end
weeble("weeble1", -5, lead)
weeble("weeble2", -2, lead)
weeble("weeble3", 2, lead)
weeble("dummy", 5)
at(1, function() blast { at = {0, 0.5}, radius = 6, impulse = 12, falloff = 2 } end)
local thrown = 0
every_step(function() thrown = math.max(thrown, math.abs(find("weeble2"):angle())) end)
expect { "the blast knocks them about", test = function() return thrown > 0.5, thrown, 0.5 end }
expect { "they get up again", from = 14, body = "weeble*", test = function()
    local most = 0
    for i = 1, 3 do local a = find("weeble" .. i):angle() most = math.max(most, math.abs(math.sin(a)), 1 - math.cos(a)) end
    return most < 0.1, most, 0.1
end }
expect { "they stand on the floor", body = "weeble*", y = {0.48, 0.53} }
expect { "the one without a weight lies", test = function()
    local tip = math.abs(math.sin(find("dummy"):angle())) return tip > 0.9, tip, 0.9
end }
