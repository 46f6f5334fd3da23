-- hot_air_balloon.lua - a burner warms the air in a balloon, which stands until that is warm enough, rises, and hovers.
-- Shows: air{} with heat inside a body that moves, a burner that goes with it (air_source{} with `body`), switched by a handler.
-- Archimedes: it leaves the ground when rho g (heat / temperature) times the area of warm air is its weight.
scene { title = "Hot-air balloon", duration = 24,
        description = "A burner warms the air inside; the balloon lifts off when Archimedes says so, and hovers by its burner." }
camera { fit = {{-5.5, -0.3}, {5.5, 8.9}}, at = 12.3 }
local g, rho, T = 9.81, 1.2, 293
air { size = {12, 12}, at = {0, 6}, cell = param("cell", 0.2, 0.1, 0.3), bottom = "closed",
      fading = 0.05, cooling = 0.07, color = "#e8884a" }
body { name = "ground", type = "static", box { 14, 0.4, at = {0, -0.2} }, color = "#7f9a5b" }

-- The envelope: most of a ring, open for a third of a radian to each side of its bottom.
local r, thick, points = 1.7, 0.3, {}
for i = 0, 40 do
    local a = -math.pi / 2 + 0.33 + (2 * math.pi - 0.66) * i / 40
    points[#points + 1] = { (r + thick) * math.cos(a), (r + thick) * math.sin(a) }
end
for i = 40, 0, -1 do
    local a = -math.pi / 2 + 0.33 + (2 * math.pi - 0.66) * i / 40
    points[#points + 1] = { r * math.cos(a), r * math.sin(a) }
end
local envelope = body { name = "balloon", label = " ", at = {0, 3.6}, mass = 1.6, outline(points), color = "#d9534f" }
local basket = body { name = "basket", label = " ", at = {0, 0.3}, mass = 1, box { 0.9, 0.6 }, color = "#a8794f" }
for side = -1, 1, 2 do
    distance { envelope, basket, at_a = {side * 0.6, 1.85}, at_b = {side * 0.42, 0.55} }
end
local weight = (1.6 + 1) * g
local fire = air_source { body = "balloon", at = {0, -1.6}, radius = 0.5, heat = 0 }

-- The lift [N] of the warm air inside, with what there is in cells that the envelope cuts.
local function lift()
    local sum, step, x, y = 0, 0.1, envelope:position()
    for i = -18, 18 do
        for j = -18, 18 do
            if (i * i + j * j) * step * step < (r + 0.05) ^ 2 then
                local _, _, _, heat = air_at(x + i * step, y + j * step)
                sum = sum + heat * step * step
            end
        end
    end
    return rho * g * sum / T
end

-- The pilot burns while the lift is less than takes the balloon to its height and brakes it there.
local wanted, burns = 4, false
every(0.1, function(t)
    local _, y = basket:position()
    local _, vy = basket:velocity()
    burns = t > 2 and lift() < weight + 3 * (wanted - y) - 25 * vy
    fire:set { heat = burns and 700 or 0, smoke = burns and 8 or 0 }
end)

local left -- lift as it leaves the ground
every_step(function()
    local _, y = basket:position()
    if not left and y > 0.305 then left = lift() end
end)
expect { "cold it stands on the ground", till = 2, body = "b*", max_speed = 0.02 }
expect { "it leaves the ground when the lift is its weight", test = function()
    return left and math.abs(left / weight - 1) < 0.04, left, weight
end }
expect { "it hovers", at = 24, body = "basket", y = {wanted - 1, wanted + 1}, vy = {-0.1, 0.1} }
expect { "then the lift is the weight, too", at = 24, test = function()
    local now = lift()
    return math.abs(now / weight - 1) < 0.04, now, weight
end }
expect { "it rises upright and straight", always = true, body = "b*", angle = {-0.05, 0.05}, x = {-0.2, 0.2} }
expect { "it does not spin", always = true, body = "balloon", max_spin = 0.1 }
expect { "its ropes hold", always = true, max_joint_error = 0.01 }
