-- half_ball.lua - a disc at 5 m/s cuts an equal one by half its width: that leaves at 30 degrees with v cos 30, the other
-- at -60 with v sin 30 (e = 1, no friction).
-- Source: Coriolis, billiards, 1835. Hard: the line of centres of the moment of the blow; that of the step's beginning is
-- up to 8 cm of way older.
-- Aim: 0.5 degrees.
scene { title = "Half-ball cut", gravity = {0, 0}, duration = 1, description = "A ball is cut by half and leaves at 30 degrees." }
local v, r = 5, 0.0286
local ivory = material { friction = 0, restitution = 1, density = 1000 }
local cue = body { name = "cue", circle { r }, at = {-1, -r}, velocity = {v, 0}, material = ivory, color = 1 }
local ball = body { name = "ball", circle { r }, at = {0, 0}, material = ivory, color = 2 }
local function direction(of)
    return function()
        local vx, vy = of:velocity()
        return degrees(math.atan(vy, vx))
    end
end
local c, s = math.cos(math.pi / 6), math.sin(math.pi / 6)
exact { "ball", measure = direction(ball), value = function() return 30 end, unit = "deg", from = 0.3 }
exact { "cue", measure = direction(cue), value = function() return -60 end, unit = "deg", from = 0.3 }
exact { "velocity", body = "ball", vx = function() return v * c * c end, vy = function() return v * c * s end, from = 0.3 }
expect { "the ball's direction", exact = "ball", tolerance = 0.00017 }
expect { "the cue's direction", exact = "cue", tolerance = 0.00017 }
expect { "the ball's velocity", exact = "velocity", tolerance = 1.5e-05 }
