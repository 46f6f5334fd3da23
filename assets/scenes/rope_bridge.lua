-- rope_bridge.lua - a rope between two banks catches crates and carries them; a lantern hangs from a thread.
-- Shows: rope{}, two-way with bodies. Statics: whatever the rope's shape, the ends hold up all that it carries and
-- itself, and of no edge is the tension other than stiffness times strain.
scene { title = "Rope bridge", description = "A rope carries crates; its ends hold up their weight.", duration = 12 }
camera { fit = {{-9, -4}, {9, 4}}, at = 10 }

local rock = material { name = "rock", friction = 0.8 }
local wood = material { name = "wood", density = 60, friction = 0.8 }
body { name = "banks", type = "static", material = rock,
       polygon {{-9, -4}, {-5, -4}, {-5, 0}, {-9, 0}}, polygon {{5, -4}, {9, -4}, {9, 0}, {5, 0}} }

local pieces, length, stiffness, mass = 40, 11, 2e5, 12 -- stiffness in N
local span = rope { from = {-5, 0}, to = {5, 0}, length = length, nodes = pieces + 1, mass = mass, stiffness = stiffness,
                    damping = 400, bending = 40, drag = 1, radius = 0.1, friction = 0.8, hold = "both", color = "#a9744f" }
local crates = 5
for i = 1, crates do
    body { name = "crate" .. i, box { 0.6, 0.6 }, at = {0.7 * i - 2.1, 1 + 0.7 * (i % 2)}, material = wood, damping = 1 }
end
local lantern = body { name = "lantern", circle { 0.2 }, at = {-6.5, 0.9}, mass = 2, color = "#e8c75a" }
local thread = rope { from = {-6.5, 2.5}, to = {-6.5, 1.1}, to_body = "lantern", hold = "from", nodes = 8, mass = 0.05,
                      stiffness = 1e4, damping = 5, color = "#4a3b32", sleep = false } -- it is to be told exactly what it carries

-- [N] that one end of the rope holds up: its edge's stiffness times strain, upward.
local function upward(near, next)
    local x, y = span:node(near)
    local u, v = span:node(next)
    local now, rest = math.sqrt((u - x) ^ 2 + (v - y) ^ 2), length / pieces
    return stiffness * (now / rest - 1) * (y - v) / now
end
local held, load = 0, 0 -- over the last seconds
every(1 / 60, function(t)
    if time() < 8 then return end
    held, load = held + upward(1, 2) + upward(pieces + 1, pieces), load + 1
end)
expect { "the ends hold up what the rope carries", at = 12, test = function()
    local weight = mass * (pieces - 1) / pieces * 9.81 -- half a piece at each end is held already
    for i = 1, crates do weight = weight + find("crate" .. i):mass() * 9.81 end
    local off = math.abs(held / load / weight - 1)
    return off < 0.01, off, 0.01
end }
expect { "the crates lie still on it", at = 12, max_speed = 0.05 }
expect { "no crate falls through", always = true, body = "crate*", y = {-3, 4} }
expect { "the lantern hangs from the thread", at = 12, body = "lantern", x = {-6.52, -6.48}, y = {0.89, 0.91} }
expect { "the thread carries the lantern", at = 12, test = function()
    local off = math.abs(thread:measure().tension / ((lantern:mass() + 0.05) * 9.81) - 1)
    return off < 0.02, off, 0.02
end }
