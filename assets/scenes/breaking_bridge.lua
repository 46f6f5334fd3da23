-- breaking_bridge.lua - a hanging bridge carries a crate, and breaks under a heavier one.
-- Shows: hinges with a breaking force, and an event for each that breaks.
-- Statics of a bridge at rest: whatever its shape, each end carries half of the weight on it.
scene { title = "Breaking bridge", description = "Hinges hold a light load and snap under a heavy one.",
        duration = 12 }
camera { fit = {{-8, -6}, {8, 4}}, at = 6.8 }

local wood = material { name = "wood", density = 40, friction = 0.7 }
local rock = material { name = "rock", friction = 0.7 }
body { name = "banks", type = "static", material = rock,
       polygon {{-9, -7}, {-5, -7}, {-5, 0}, {-9, 0}}, polygon {{5, -7}, {9, -7}, {9, 0}, {5, 0}},
       box { 10, 1, at = {0, -6.5} } }

-- The planks, hinged to one another and to the banks.
local planks, strength = 12, 18000 -- strength in N
local length = 10 / planks
local rubs = { speed = 0, torque = 60 } -- a motor that wants to stand still is friction in the hinge
local last = "banks"
for i = 1, planks do
    local x = -5 + (i - 0.5) * length
    local plank = body { name = "plank" .. i, box { length - 0.05, 0.2, round = 0.02 }, at = {x, -0.1},
                         material = wood, color = "#a9744f" }
    revolute { last, plank, at = {x - length / 2, -0.1}, name = "hinge" .. i, motor = rubs,
               break_force = strength }
    last = plank
end
revolute { last, "banks", at = {5, -0.1}, name = "hinge" .. planks + 1, motor = rubs, break_force = strength }

local crate = body { name = "crate", box { 1, 1 }, at = {0, 0.8}, mass = 40, color = "#5b8fbf" }
at(6, function() body { name = "safe", box { 1.4, 1.4 }, at = {2.1, 1.2}, mass = 1500, color = "#4a5568" } end)
on_break(function(name) score("broken hinges", score("broken hinges") + 1) end)

-- At rest, before the safe comes: half of the weight at each end.
expect { "each end carries half the weight", at = 5.9, test = function()
    local weight = crate:mass() * 9.81
    for i = 1, planks do weight = weight + find("plank" .. i):mass() * 9.81 end
    local _, left = find_joint("hinge1"):force()
    local off = math.abs(left / (weight / 2) - 1)
    return off < 0.03, off, 0.03
end }
expect { "the bridge holds the crate", at = 5.9, broken = 0, max_joint_error = 0.02 }
expect { "the bridge holds the crate still", at = 5.9, max_speed = 0.05 }
expect { "the safe breaks it", broken = {1, 6} }
expect { "the safe has fallen", body = "safe*", y = {-6, -4} }
