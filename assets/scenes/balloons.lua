-- balloons.lua - two balloons carry a board; a third is pressed until it bursts.
-- Shows: balloon{}. In each skin (pressure + ambient) times area is constant; where it tears, the gas is gone.
scene {
    title = "Balloons",
    description = "Two balloons carry a board; a third is pressed until it bursts.",
    duration = 8,
}
local soft = material { density = 40, friction = 0.6 }
body { type = "static", box { 14, 1 }, at = {0, -0.5} }

local carry = {}
for i = 1, 2 do
    carry[i] = balloon { at = {-5 + 1.8 * i, 0.85}, radius = 0.75, nodes = 32, mass = 1, pressure = 1500, stiffness = 6e3, damping = 10,
                         bending = 0.2, drag = 0.5, color = "#3f8fd2" }
end
local board = body { name = "board", box { 3.2, 0.2 }, at = {-2.3, 1.9}, material = soft }

local bursts = balloon { at = {3, 0.85}, radius = 0.8, nodes = 36, mass = 1, pressure = 1500, ambient = 1e4, stiffness = 6e3, damping = 10,
                         bending = 0.1, drag = 0.5, break_strain = 0.2, color = "#e0564f" }
local press = body { name = "press", type = "kinematic", box { 2, 0.3 }, at = {3, 2.4}, velocity = {0, -0.4} }
at(4, function() press:set_velocity(0, 0.8) end)
at(6, function() press:set_velocity(0, 0) end)
camera { fit = {{-6, -1}, {6, 3.5}} }

local was_whole = false
at(1, function() was_whole = bursts:measure().torn == 0 end)
expect { "the board is carried", at = 8, body = "board", y = {1.2, 1.9} }
-- Pressure of 1500 N/m at rest; of the skins' circles, polygons of 32 corners.
local whole = 16 * 0.75 * 0.75 * math.sin(math.pi / 16)
expect { "pressure times area is as at rest", at = 8, test = function()
    local m = carry[1]:measure()
    local off = math.abs(m.pressure * m.area / (1500 * whole) - 1)
    return off < 1e-3, off, 1e-3
end }
expect { "the third is whole at first and bursts", at = 8, test = function() return was_whole and bursts:measure().torn > 0 end }
