-- blast.lua - a bomb between a stack in the open and one behind a wall.
-- Shows: blast{} with occlusion, a body locked to a rail, tar that holds a lump on the wall, a target.
scene { title = "Blast", description = "What sees the bomb flies; what hides behind the wall stands.", duration = 6 }
camera { fit = {{-13, -0.6}, {9, 7}}, at = 1.45, trail = 0.4 }
local wood = material { name = "wood", density = 400, friction = 0.6, restitution = 0.1 }
local rock = material { name = "rock", friction = 0.7 }
local tar = material { name = "tar", density = 100, friction = 0.8, adhesion = 3000 }

body { name = "ground", type = "static", box { 80, 1 }, at = {0, -0.5}, material = rock }
body { name = "wall", type = "static", box { 0.6, 4.4 }, at = {3, 2.2}, material = rock }
for i = 1, 4 do
    body { name = "open" .. i, box { 1, 1 }, at = {-4, i - 0.5}, material = wood, color = 1 }
    body { name = "hidden" .. i, box { 1, 1 }, at = {5, i - 0.5}, material = wood, color = 2 }
end
-- Hangs from nothing: it can only go sideways, and not far in such thick air.
body { name = "trolley", box { 1.6, 0.4 }, at = {-1, 6}, lock = {"y", "rotation"}, damping = 2, material = wood, color = 5 }
body { name = "blob", box { 0.5, 0.5 }, at = {1.2, 3}, velocity = {6, 2}, material = tar, color = 3 }
body { name = "bomb", circle { 0.35 }, at = {0, 0.35}, material = rock, color = 8 }
local plunger = body { name = "plunger", type = "kinematic", box { 0.2, 1 }, at = {7.5, 1.2}, material = wood, color = 4 }

at(0.7, function() plunger:move_to(7.5, 0.5, 0, 0.3) end)
at(1, function()
    find("bomb"):destroy()
    blast { at = {0, 0.5}, radius = 4, falloff = 8, impulse = 3000, occlusion = "walls" }
end)

expect { "all stands before the blast", from = 0.5, till = 0.95, body = "open*", max_speed = 0.05 }
expect { "the open stack flies", at = 2, body = "open1", x = {-40, -7} }
expect { "and so does its top", at = 2, body = "open4", x = {-40, -6} }
expect { "the hidden stack stands", from = 0.5, body = "hidden*", x = {4.9, 5.1} }
expect { "the trolley keeps to its rail", always = true, body = "trolley", y = {6, 6} }
expect { "the blob sticks where it hit", from = 0.6, till = 0.95, body = "blob", x = {2.44, 2.46}, max_speed = 0.02 }
expect { "the plunger has arrived", at = 3, body = "plunger", position = {7.5, 0.5}, tolerance = 1e-6 }
