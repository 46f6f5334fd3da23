-- curtain.lua - a ball is shot through a curtain, which tears.
-- Shows: cloth{} that tears at a strain. What the ball loses, the curtain and its edges have taken: energy does not grow.
scene { title = "Curtain", description = "A ball goes through a curtain of threads.", duration = 2.5 }
camera { fit = {{-5, -0.5}, {5, 5}}, at = 0.45 }

local rock = material { name = "rock", friction = 0.6 }
body { name = "ground", type = "static", material = rock, box { 12, 1, at = {0, -0.5} } }
body { name = "rod", type = "static", box { 4.6, 0.1, at = {0.5, 4.35} } }
local cloth_ = cloth { at = {0.5, 2.6}, size = {4, 3.4}, columns = 13, rows = 11, hold = "top", mass = 3, stiffness = 4e3, shear = 400,
                       damping = 1, drag = 0.5, radius = 0.15, friction = 0.3, break_strain = 0.25, color = "#b0506a" }
local ball = body { name = "ball", circle { 0.35 }, at = {-4, 2.4}, velocity = {14, 1.5}, mass = 8, material = rock, color = "#4a5568" }
local before = 8 * (14 * 14 + 1.5 * 1.5) / 2
local energy = function()
    local vx, vy = ball:velocity()
    local _, y = ball:position()
    local m = cloth_:measure()
    return 8 * (vx * vx + vy * vy) / 2 + 8 * 9.81 * (y - 2.4) + m.kinetic + m.elastic + m.mass * 9.81 * (m.y - 2.6)
end
local most, through = 0, 0
every(1 / 60, function()
    most = math.max(most, energy())
    local x = ball:position()
    if x < 3.5 then through = ball:velocity() end
end)
expect { "the curtain is torn", at = 2.5, test = function() return cloth_:measure().torn > 2, cloth_:measure().torn, 2 end }
expect { "the ball has gone through, slower", at = 2.5, test = function() return through > 2 and through < 13, through, 13 end }
expect { "no energy came from nowhere", at = 2.5, test = function() return most < 1.01 * before, most, 1.01 * before end }
