-- drops.lua - water in a space station: drops of any shape swing, drift together, merge and wobble on.
-- Shows: tension of liquid{}: its surface pulls itself together, pressure tension / radius inside.
scene { title = "Drops", duration = 24, gravity = { 0, 0 }, description = "Drops in weightlessness: a square rounds itself, drops meet, merge and wobble." }
camera { fit = { {-2.6, -1.6}, {2.6, 1.6} }, at = 7 }

liquid { spacing = 0.04, tension = param("tension", 60, 30, 120), viscosity = 0.5, color = "#3aa0e0" }

local area, px, py = 0, 0, 0 -- [m^2], and momentum over density
local function drop(what)
    liquid(what)
    local now = liquid_in(-9, -9, 9, 9)
    px, py = px + (now - area) * what.velocity[1], py + (now - area) * what.velocity[2]
    area = now
end
drop { box { 0.9, 0.9, at = { -1.6, 0.5 } }, velocity = { 0.10, -0.03 }, dye = "#2f7fd0" }
drop { circle { 0.5, at = { 0.3, -0.5 } }, velocity = { 0, 0.04 }, dye = "#36b0c8" }
drop { box { 1.2, 0.5, at = { 1.5, 0.5 } }, velocity = { -0.09, -0.02 }, dye = "#5a8be8" }
drop { polygon { {-0.9, -1.5}, {-0.1, -1.4}, {-0.7, -0.8} }, velocity = { 0.03, 0.05 }, dye = "#60c8b0" }
local _, _, _, x0, y0 = liquid_in(-9, -9, 9, 9)

local function speed() return (select(3, liquid_in(-9, -9, 9, 9))) end
local fastest = 0
every_step(function() fastest = math.max(fastest, speed()) end)

expect { "but for some spray where they meet it stays together", at = 24, test = function()
    local near = liquid_in(-2.6, -1.6, 2.6, 1.6)
    return near > 0.97 * area, near, 0.97 * area
end }
expect { "surfaces pull: it moves faster than it was thrown", at = 5, test = function() return fastest > 0.12, fastest, 0.12 end }
expect { "its centre goes on as it was thrown", at = 24, test = function()
    local _, _, _, x, y = liquid_in(-99, -99, 99, 99)
    local off = math.sqrt((x - x0 - 24 * px / area) ^ 2 + (y - y0 - 24 * py / area) ^ 2)
    return off < 0.1, off, 0.1
end }
