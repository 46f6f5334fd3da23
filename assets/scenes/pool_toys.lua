-- pool_toys.lua - soft things in water that flows: a ball, a float that carries a crate, jelly that sinks, a ring that a ball drops into.
-- Shows: balloon{} and jelly{} in liquid{}: what they displace carries them, water presses them together, nodes are in its pressures.
scene { title = "Pool toys", duration = 12, description = "Soft bodies float as deep as they weigh, carry what lies on them, and stir the water." }
camera { fit = { {-3.4, -0.4}, {3.4, 4.2} }, at = 2.2 }
local tiles = material { friction = 0.4 }
body { type = "static", name = "pool", material = tiles, box { 7, 0.4, at = { 0, -0.2 } }, box { 0.4, 4, at = { -3.3, 1.6 } },
       box { 0.4, 4, at = { 3.3, 1.6 } } }
liquid { spacing = param("spacing", 0.045, 0.03, 0.1), color = "#3d8fc6", box { 6.2, 1.8, at = { 0, 0.9 } } }

local ball = balloon { at = { -2.1, 3.4 }, radius = 0.45, nodes = 32, mass = 4, pressure = 2e4, stiffness = 2e5, bending = 1, color = "#e0564f" }
local raft = jelly { box { 2.2, 0.4, at = { 0.2, 2.05 } }, spacing = 0.2, density = 150, young = 4e5, color = "#f2c230" }
local crate = body { name = "crate", box { 0.4, 0.4 }, density = 350, at = { 0.2, 3.2 }, color = 6 }
local stone = jelly { circle { 0.3, at = { -1.2, 2.5 } }, spacing = 0.15, density = 1400, young = 1e5, color = "#a05ac8" }
local tube = balloon { at = { 2.2, 2.6 }, radius = 0.5, nodes = 32, mass = 60, pressure = 2e4, stiffness = 2e5, bending = 1, color = "#5aa66a" }

local function lies(soft, low, high)
    local y = soft:measure().y
    return y > low and y < high, y, high
end
expect { "nothing leaves the pool", always = true, test = function() return liquid_in(-3.12, -0.01, 3.12, 9) == liquid_in(-99, -99, 99, 99) end }
expect { "nothing is thrown out", always = true, max_speed = 9 }
expect { "the ball lies on the water", at = 12, test = function() return lies(ball, 2.1, 2.6) end }
expect { "the float carries the crate", at = 12, body = "crate", y = { 2.0, 2.8 } }
expect { "the jelly sinks", at = 12, test = function() return lies(stone, 0.1, 0.5) end }
expect { "the heavier ball is a tenth under", at = 12, test = function() return lies(tube, 2.0, 2.5) end }
