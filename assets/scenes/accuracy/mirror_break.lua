-- mirror_break.lua - a cue ball straight into a triangle of 15 touching balls: what comes of it is its own mirror image.
-- The quantity is the largest difference of a ball's velocity from its partner's mirrored one, over the cue ball's speed.
-- Source: symmetry. Hard: simultaneous blows are solved one after another, in some order.
-- Rounding is left: blows of one moment are solved together.
scene { title = "Symmetric break", gravity = {0, 0}, duration = 1, description = "A symmetric break stays symmetric." }
local r, v = 0.0286, 5
local ivory = material { friction = 0, restitution = 0.95, density = 1000 }
local cue = body { name = "cue", circle { r }, at = {-0.5, 0}, velocity = {v, 0}, material = ivory, sleep = false }
local rows = {}
for row = 0, 4 do
    rows[row] = {}
    for k = 0, row do
        rows[row][k] = body { circle { r }, at = {row * r * math.sqrt(3), (2 * k - row) * r}, material = ivory, sleep = false }
    end
end
exact { "asymmetry", at = 1, value = function() return 0 end, measure = function()
    local _, vy = cue:velocity()
    local worst = math.abs(vy)
    for row = 0, 4 do
        for k = 0, row do
            local ax, ay = rows[row][k]:velocity()
            local bx, by = rows[row][row - k]:velocity()
            worst = math.max(worst, math.sqrt((ax - bx) * (ax - bx) + (ay + by) * (ay + by)))
        end
    end
    return worst / v
end }
expect { "mirror images", exact = "asymmetry", tolerance = 1.3e-07 }
