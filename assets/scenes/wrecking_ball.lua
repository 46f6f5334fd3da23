-- wrecking_ball.lua - a ball on a chain swings into a wall of bricks.
-- Shows: a chain of revolute joints with a heavy weight at its end (120 times a link), blows told by
-- on_hit. A pendulum that falls keeps its energy, and the chain must not lengthen.
scene { title = "Wrecking ball", description = "A heavy ball on a light chain.", duration = 9, substeps = 16 }
camera { fit = {{-9, -0.8}, {9, 11}}, at = 1.95 }

local iron = material { name = "iron", density = 200, friction = 0.4 }
local brick = material { name = "brick", density = 60, friction = 0.6 }
body { name = "ground", type = "static", box { 80, 1 }, at = {0, -0.5}, material = brick }
local crane = body { name = "crane", type = "static", box { 0.6, 0.6 }, at = {0, 9.5}, color = "#d69e2e" }

-- The chain lies level to the left of its hook, the ball at its end.
local links, step = 12, 0.5
local x, y, last = 0, 9.5, crane
for i = 1, links do
    local link = body { name = "link" .. i, capsule { step * 0.7, 0.06 }, at = {x - step / 2, y}, mass = 5,
                        apart = "chain", color = "#718096" }
    revolute { last, link, at = {x, y}, name = "pin" .. i }
    last, x = link, x - step
end
local ball = body { name = "ball", circle { 0.8 }, at = {x - 0.8, y}, mass = 600, material = iron, color = "#2d3748" }
revolute { last, ball, at = {x, y}, name = "pin" .. links + 1 }

-- The wall: courses of bricks, every other one shifted by half a brick.
local rows, columns = 9, 3
for row = 0, rows - 1 do
    for column = 1, columns do
        body { name = ("brick_%d_%d"):format(row, column), box { 0.98, 0.5 }, material = brick,
               at = {2.2 + column + (row % 2) * 0.5, 0.25 + row * 0.5}, color = row % 2 == 0 and "#c0673f" or "#a9552f" }
    end
end

score("hits", 0)
on_hit { a = "ball", b = "brick*", speed = 3, function(_, _, blow)
    score("hits", score("hits") + 1)
    score("hardest [N s]", math.max(score("hardest [N s]"), math.floor(blow.impulse)))
end }

-- Until it strikes, nothing takes energy out: what is lost or gained is the solver's error.
local start
at(0, function() local kinetic, potential = energy() start = kinetic + potential end)
expect { "it falls as a pendulum does", from = 0.1, till = 1.1, test = function()
    local kinetic, potential = energy()
    local off = math.abs(kinetic + potential - start) / (600 * 9.81 * 6.8)
    return off < 0.02, off, 0.02
end }
expect { "the chain does not give", till = 1.1, max_joint_error = 0.02 }
expect { "the ball struck the wall", score = "hits", value = {2, 1000} }
expect { "the wall's top course is gone", test = function()
    local down = 0
    for column = 1, columns do
        local _, top = find(("brick_%d_%d"):format(rows - 1, column)):position()
        if top < 3 then down = down + 1 end
    end
    return down == columns, down, columns
end }
expect { "nothing sank into the ground", body = "brick*", y = {0.1, 8} }
