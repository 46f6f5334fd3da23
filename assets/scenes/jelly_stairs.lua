-- jelly_stairs.lua - a cube of jelly tumbles down stairs behind a ball.
-- Shows: jelly{}. What is elastic comes back to its shape: when all is still, only its own weight presses it.
scene { title = "Jelly on stairs", description = "Jelly tumbles down stairs and is back in shape.", duration = 12 }
camera { fit = {{-5.5, -1}, {8.5, 6}}, at = 1.2 }

local rock = material { name = "rock", friction = 0.6 }
body { name = "ground", type = "static", material = rock, box { 15, 1, at = {2, -0.5} }, box { 0.5, 3, at = {8.5, 1} } }
for i = 1, 6 do
    body { name = "step" .. i, type = "static", material = rock, box { 1.2, 1 * (7 - i) * 0.6, at = {-5.4 + 1.2 * i, (7 - i) * 0.3} } }
end
local young, density = 8e4, 120 -- Pa, kg/m^2
local cube = jelly { box { 1.2, 1.2, at = {-3.9, 4.6} }, velocity = {3.5, 0}, spacing = 0.2, density = density, young = young,
                     friction = 0.3, drag = 0.4, color = "#d9577a" }
local ball = body { name = "ball", circle { 0.4 }, at = {-2.4, 4.2}, velocity = {3.5, 0}, mass = 30, material = rock, damping = 0.4,
                    color = "#5aa66a" }

local most = 0 -- J
every(1 / 60, function() most = math.max(most, cube:measure().elastic) end)
-- What its own weight stores in a block of width w and height h that lies: (rho g)^2 w h^3 / (6 E).
local lying = (density * 9.81) ^ 2 * math.pow(1.2, 4) / (6 * young)
expect { "the stairs have pressed the jelly hard", at = 12, test = function() return most > 10 * lying, most, 10 * lying end }
expect { "the cube is pressed by its weight alone", at = 12, test = function()
    local m = cube:measure()
    local off = math.abs(m.elastic / lying - 1)
    return off < 0.2, off, 0.2
end }
expect { "the cube is down the stairs, on the ground", at = 12, test = function()
    local m = cube:measure()
    return m.x > 2.5 and m.y > 0.58 and m.y < 0.72, m.y, 0.72
end }
expect { "the cube is still", at = 12, test = function()
    local m = cube:measure()
    local v = math.sqrt(2 * m.kinetic / m.mass)
    return v < 0.02, v, 0.02
end }
expect { "the ball did not go into it", always = true, test = function()
    local m = cube:measure()
    local x, y = ball:position()
    local way = math.sqrt((x - m.x) ^ 2 + (y - m.y) ^ 2)
    return way > 0.7, way, 0.7
end }
