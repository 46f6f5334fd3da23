-- tilt.lua - a maze that is turned in the hand: gravity goes with the stick. The walls stand, the balls go where down is; all of
-- them find the tray in the end.
scene { title = "Tilted maze", duration = 24, sleep = false, description = "Gravity that turns with the stick." }
local wood = material { name = "wood", friction = 0.3, restitution = 0.2 }
local steel = material { name = "steel", density = 8, friction = 0.1, restitution = 0.3 }
local function wall(x, y, w, h, color)
    body { type = "static", box { w, h }, at = {x, y}, material = wood, color = color or "#8a6d4b" }
end
wall(0, 5.2, 10.8, 0.4) wall(0, -5.2, 10.8, 0.4) wall(5.2, 0, 0.4, 10) wall(-5.2, 0, 0.4, 10)
wall(-1.2, 2.6, 7.6, 0.3, "#b7791f") wall(1.2, 0, 7.6, 0.3, "#b7791f") wall(-1.2, -2.6, 7.6, 0.3, "#b7791f")
body { name = "tray", type = "static", box { 9.8, 1.8, sensor = true }, at = {0, -4}, color = "#38a169" }
for i = 1, 8 do
    body { name = "ball" .. i, circle { 0.35 }, at = {-4.6 + 0.8 * i, 4.4}, material = steel, color = i % 6 }
end
-- The stick: down to the right, to the left, and so on, never more than 50 degrees.
local function stick(t) return 0.87 * math.sin(2 * math.pi * t / 8) end
every_step(function()
    local a = stick(time())
    set_gravity(9.81 * math.sin(a), -9.81 * math.cos(a))
end)
camera { fit = {{-6, -5.6}, {6, 5.6}}, at = 5.5, trail = 0.5 }
expect { "all are in the tray", body = "tray", inside = {8, 8}, at = 24 }
expect { "nothing is pushed through a wall", at = 24, max_penetration = 0.01 }
