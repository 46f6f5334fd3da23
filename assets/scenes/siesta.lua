-- siesta.lua - a hammock, a lantern and jelly come to rest and sleep; a nut that falls wakes the one that it hits.
-- Shows: soft bodies asleep with what they hold or touch: they cost nothing, and stay where statics has them.
scene { title = "Siesta", description = "A hammock, a lantern and jelly fall asleep; a nut wakes the jelly.", duration = 24 }
camera { fit = {{-5.5, -0.6}, {5, 4.2}}, at = 9.9 }

local wood = material { name = "wood", density = 400, friction = 0.7 }
body { name = "ground", type = "static", material = wood, box { 16, 1, at = {0, -0.5} }, color = "#8a9a5b" }
body { name = "posts", type = "static", material = wood, box { 0.25, 3, at = {-4.8, 1.5} }, box { 0.25, 3.6, at = {-0.6, 1.8} },
       box { 1.6, 0.15, at = {0.3, 3.5} }, color = "#7a5a3a" }

local nodes, length, stiffness = 33, 4.4, 6e4 -- m, N
local hammock = rope { from = {-4.65, 2.4}, to = {-0.75, 2.4}, length = length, nodes = nodes, mass = 2, stiffness = stiffness,
                       damping = 300, bending = 2, drag = 1, radius = 0.07, friction = 0.8, hold = "both", color = "#c9b38a" }
local melon = body { name = "melon", circle { 0.4 }, at = {-2.7, 2.3}, mass = 20, material = wood, damping = 1, color = "#4f8a4c" }
local lantern = body { name = "lantern", box { 0.3, 0.4 }, at = {0.9, 2.2}, mass = 2, damping = 1, color = "#e8c75a" }
local cord = rope { from = {0.9, 3.4}, to = {0.9, 2.4}, to_body = "lantern", hold = "from", nodes = 9, mass = 0.05,
                    stiffness = 5e3, damping = 20, drag = 1, color = "#4a3b32" }
local jelly = jelly { box { 1.4, 0.9, at = {3, 0.55} }, spacing = 0.1, density = 120, young = 6e4, damping = 0.02, drag = 0.5,
                      friction = 0.6, color = "#d9577a" }
local book = body { name = "book", box { 0.8, 0.15 }, at = {3, 1.3}, material = wood, damping = 0.5, color = "#3f6fb0" }

local parts = { hammock = hammock, melon = melon, lantern = lantern, cord = cord, jelly = jelly, book = book }
local function asleep(...)
    local count = 0
    for _, name in ipairs({ ... }) do
        count = count + (parts[name]:awake() and 0 or 1)
    end
    return count
end

local sag = 0 -- m
at(9.5, function() sag = select(2, hammock:node(17)) end)
local woken = false
local corners = {}
for i = 1, 6 do
    corners[i] = { 0.14 * math.cos(i * math.pi / 3), 0.14 * math.sin(i * math.pi / 3) }
end
at(10, function() body { name = "nut", polygon(corners), at = {3.1, 3.6}, mass = 0.8, material = wood, color = "#8b8f94" } end)
every(1 / 60, function() woken = woken or (time() > 10 and asleep("jelly", "book") == 0) end)

expect { "all of them sleep before the nut falls", at = 9.9, test = function()
    local n = asleep("hammock", "melon", "lantern", "cord", "jelly", "book")
    return n == 6, n, 6
end }
-- Of two straight halves of a rope that bears m g: y = -h, T = m g / (2 sin a); what it weighs itself bends them a little.
expect { "the hammock hangs as statics has it", at = 9.9, test = function()
    local half, x, y = 1.95, hammock:node(17)
    local depth = 2.4 - y
    local sine = depth / math.sqrt(half ^ 2 + depth ^ 2)
    local tension = (20 + 2) * 9.81 / (2 * sine)
    local off = math.abs(hammock:measure().tension / tension - 1)
    return off < 0.1, off, 0.1
end }
expect { "the lantern pulls its cord by its weight", at = 9.9, test = function()
    local off = math.abs(cord:measure().tension / (2.05 * 9.81) - 1)
    return off < 0.02, off, 0.02
end }
expect { "the nut woke the jelly and the book on it", at = 24, test = function() return woken end }
expect { "hammock and lantern slept on", always = true, test = function()
    local n = time() < 10 and 4 or asleep("hammock", "melon", "lantern", "cord")
    return n == 4, n, 4
end }
expect { "asleep it stands still", at = 24, test = function()
    local off = math.abs(select(2, hammock:node(17)) - sag)
    return off == 0, off, 0
end }
expect { "all of them sleep again", at = 24, test = function()
    local n = asleep("hammock", "melon", "lantern", "cord", "jelly", "book")
    return n == 6, n, 6
end }
