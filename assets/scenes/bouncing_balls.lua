-- bouncing_balls.lua - balls of e = 0, 0.5, 0.8 and 1 fall from the same height.
-- Shows: restitution at the true height of the contact. The n-th apex is e^(2n) h, exactly:
-- a fall from h takes sqrt(2 h / g); after a bounce the speed is e times that before.
scene { title = "Bouncing balls", duration = 6,
        description = "The n-th apex of a bouncing ball is e^(2n) times the height of the fall." }
camera { fit = {{-4, -0.6}, {4, 3.4}} }

local g, h, r = 9.81, 2, 0.3
body { name = "ground", type = "static", box { 12, 0.5 }, at = {0, -0.25} }

-- Height of the ball's lowest point at time t.
local function height(e, t)
    local fall = math.sqrt(2 * h / g)
    if t < fall then return h - g * t * t / 2 end
    t = t - fall
    local v = e * g * fall
    while v > 1e-3 do
        local flight = 2 * v / g
        if t < flight then return v * t - g * t * t / 2 end
        t = t - flight
        v = e * v
    end
    return 0
end

for i, e in ipairs { 0, 0.5, 0.8, 1 } do
    local m = material { name = "e" .. i, density = 1000, friction = 0, restitution = e }
    local name = "ball_e" .. math.floor(10 * e + 0.5)
    local x = (i - 2.5) * 1.6
    body { name = name, circle { r }, at = {x, h + r}, material = m, fixed_rotation = true, color = i,
           label = ("e = %.1f"):format(e) }
    exact { body = name, x = function() return x end, y = function(t) return r + height(e, t) end, till = 3 }
    -- the first three apexes, each at its own time
    local fall = math.sqrt(2 * h / g)
    local t, v = fall, e * g * fall
    for n = 1, 3 do
        if v > 0.5 then
            local apex = r + v * v / (2 * g)
            expect { ("e = %.1f, apex %d"):format(e, n), at = t + v / g, body = name, y = apex, tolerance = 0.004 }
        end
        t = t + 2 * v / g
        v = e * v
    end
    if e == 0 then
        expect { "e = 0.0 does not bounce", from = 1, body = name, y = r, tolerance = 0.005 }
    end
    if e == 1 then
        -- With the world's other balls losing theirs, its own energy: v^2 / 2 + g y.
        expect { "e = 1.0 keeps its energy", always = true, test = function()
            local ball = find(name)
            local _, y = ball:position()
            local v1 = ball:speed()
            local drift = math.abs((v1 * v1 / 2 + g * (y - r)) / (g * h) - 1)
            return drift < 0.001, drift, 0.001
        end }
    end
end
