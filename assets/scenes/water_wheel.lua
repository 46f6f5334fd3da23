-- water_wheel.lua - a stream turns an undershot wheel, which lifts a bucket.
-- Shows: a current, drag on each paddle as deep as it dips, work done by it; discs that drift by.
scene { title = "Water wheel", description = "A stream of 2.5 m/s turns the wheel, whose paddles go slower than it, and winds up a weight.", duration = 16 }
camera { fit = {{-7, -2.4}, {9, 6}}, at = 6 }
local speed = param("speed", 2.5, 0, 6)
body { type = "static", box { 40, 0.5, at = {0, -2.25} }, density = 2000, name = "bed" }
local stream = water { name = "stream", box { 40, 2 }, at = {0, -1}, flow = {speed, 0} }

-- Eight paddles on a wheel of 2 m, which hangs 1.3 m above the water.
local parts = { circle { 0.35 } }
for i = 0, 7 do
    local a = i * math.pi / 4
    parts[#parts + 1] = box { 1.9, 0.09, at = {1.1 * math.cos(a), 1.1 * math.sin(a)}, angle = a }
end
local wheel = body { name = "wheel", at = {0, 1.4}, density = 500, category = "wheel", ignores = "float", color = 1, shapes = parts }
revolute { wheel, at = {0, 1.4}, hidden = true }
body { type = "static", category = "frame", collides = {}, polygon { {-0.25, -2}, {0.25, -2}, {0.12, 1.4}, {-0.12, 1.4} } }

-- A drum of 0.35 m winds a rope that goes over a wheel to the weight.
local weight = body { name = "weight", box { 0.7, 0.7 }, density = 120, at = {5, 0.9}, color = 6 }
body { type = "static", box { 4, 0.3, at = {5, 0.3} }, category = "frame" }
local rope = distance { world, weight, at_a = {5, 5.2}, at_b = {5, 1.25}, limits = {0, 3.95}, name = "rope" }
local wound = 0
every_step(function()
    wound = math.min(wound + 0.35 * wheel:spin() / 60, 2.6)
    rope:set_limits(0, 3.95 - wound)
    wheel:apply_torque(-0.35 * rope:reaction())
end)

local floats = {}
for i = 1, 6 do
    floats[i] = body { name = "float" .. i, circle { 0.16 }, density = 400, at = {-6.5 + 0.5 * i, -0.02}, category = "float", ignores = "wheel", color = 2 + i }
end

-- The paddles dip at 1.4 m and more: no faster than the stream where they do.
expect { "the wheel turns with the stream", at = 6, test = function() local w = wheel:spin() return w > 0.5, w, 0.5 end }
expect { "no paddle outruns it", always = true, test = function() local w = wheel:spin() return w * 1.4 < speed, w * 1.4, speed end }
expect { "what floats goes with the stream", at = 3, test = function() local v = floats[6]:velocity() return math.abs(v - speed) < 0.2, v, speed end }
expect { "the weight is lifted", at = 14, body = "weight", y = {2.5, 5} }
