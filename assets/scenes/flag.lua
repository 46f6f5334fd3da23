-- flag.lua - a flag in gusts, and a streamer in an even wind.
-- Shows: wind acts on soft bodies by their drag. A streamer hangs straight in an even wind, at tan(angle) = drag U / g from the vertical,
-- for on each of its nodes the same two forces act.
scene { title = "Flag", description = "A flag in gusts; a streamer shows the speed of an even wind.", duration = 12, seed = 2 }
camera { fit = {{-7, 0}, {7, 6.5}}, at = 6 }
body { name = "ground", type = "static", box { 16, 0.4, at = {0, -0.2} } }
body { name = "masts", type = "static", collides = {}, box { 0.12, 6, at = {-5, 3} }, box { 0.12, 4, at = {4, 2} } }

wind { category = "gusts", box { 9, 8, at = {-2.5, 4} }, flow = {7, 0}, gust = 0.4, gust_length = 8 }
wind { category = "even", box { 5, 8, at = {5, 4} }, flow = {4, 0} }

local columns, rows = 14, 7
local flag = cloth { at = {-3.2, 5}, size = {3.6, 1.8}, columns = columns, rows = rows, mass = 0.6, stiffness = 800, shear = 60, damping = 0.2,
                     drag = 5, radius = 0.02, color = "#c0392b", collides = "gusts" }
for row = 0, rows do
    local node = 1 + row * (columns + 1)
    local x, y = flag:node(node)
    flag:hold(node, x, y)
end
local drag = 3
local streamer = rope { from = {4, 4}, to = {4, 1.6}, hold = "from", nodes = 20, mass = 0.1, stiffness = 500, drag = drag, radius = 0.03,
                        color = "#2d6cdf", collides = "even" }

local highest, lowest = -10, 10
every(1 / 60, function()
    if time() < 3 then return end
    local _, y = flag:node((rows + 1) * (columns + 1))
    highest, lowest = math.max(highest, y), math.min(lowest, y)
end)
expect { "the flag streams", at = 12, test = function() local m = flag:measure() return m.x > -3.9 and m.y > 4, m.x, -3.9 end }
expect { "gusts lift it and let it fall", at = 12, test = function() return highest - lowest > 0.3, highest - lowest, 0.3 end }
expect { "the streamer hangs as the wind has it", at = 12, test = function()
    local x, y = streamer:node(20)
    local off = math.abs((x - 4) / (4 - y) / (drag * 4 / 9.81) - 1)
    return off < 1e-3, off, 1e-3
end }
