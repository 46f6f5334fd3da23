-- friction_spring.lua - a block on a spring and a rough floor: half swings about -+ d, d = mu g / w^2, each shorter by 2
-- d, until it turns within d and sticks.
-- Source: Rayleigh, Theory of Sound; any textbook on dry friction. Hard: the force jumps at each turning point.
-- Aim: 1e-3 m.
scene { title = "Spring and dry friction", duration = 4, description = "A block on a spring stops by friction." }
local g, mu, a, f = 9.81, 0.15, 0.5, 1
local w = 2 * math.pi * f
local rough = material { friction = mu }
body { name = "floor", type = "static", box { 6, 1 }, at = {0, -0.5}, material = rough }
local block = body { name = "block", box { 0.4, 0.4 }, at = {a, 0.2}, material = rough, fixed_rotation = true, sleep = false }
distance { world, block, at_a = {-10, 0.2}, length = 10, spring = { frequency = f, damping = 0 } }
local d = mu * g / (w * w)
exact { "place", body = "block", x = function(t)
    local half, x, side = math.pi / w, a, 1 -- swings from x towards side * d
    while math.abs(x) > d do
        if t < half then return side * d + (x - side * d) * math.cos(w * t) end
        t, x, side = t - half, 2 * side * d - x, -side
    end
    return x
end }
expect { "the swings and the stop", exact = "place", tolerance = 0.00022 }
