-- scissor_lift.lua - a scissor lift of four storeys bears a crate (Box2D's sample). Its lower feet are bolted.
-- Fails: soft joints: the lift folds down in Plumb and in Box2D. Right: bolted, it is a rigid frame: it does not move.
scene { title = "Scissor lift", duration = 5 }
local storeys, load = param("storeys", 4, 1, 12), param("load", 200, 1, 1e6)
local ground = body { type = "static", box { 20, 1 }, at = {0, -0.5} }
local angle, half = 0.5, 1.5
local dx, dy = half * math.cos(angle), half * math.sin(angle)
local below_left, below_right
for i = 1, storeys do
    local y = (2 * i - 1) * dy + 0.1
    local a = body { name = "a" .. i, capsule { 2 * half, 0.06 }, at = {0, y}, angle = angle, mass = 10, apart = "lift" }
    local b = body { name = "b" .. i, capsule { 2 * half, 0.06 }, at = {0, y}, angle = -angle, mass = 10, apart = "lift" }
    revolute { a, b, at = {0, y} }
    revolute { below_left or ground, a, at = {-dx, y - dy} }
    revolute { below_right or ground, b, at = {dx, y - dy} }
    below_left, below_right = b, a
end
local top = 2 * storeys * dy + 0.1
local deck = body { name = "deck", box { 3, 0.2 }, at = {0, top + 0.1}, mass = 20, apart = "lift" }
revolute { below_left, deck, at = {-dx, top} }
revolute { below_right, deck, at = {dx, top} }
body { name = "crate", box { 1, 1 }, at = {0, top + 0.7}, mass = load }

expect { "the deck sinks by 2 cm at most", always = true, body = "deck", y = {top + 0.08, top + 0.12} }
expect { "the deck stays level", always = true, body = "deck", angle = {-0.02, 0.02} }
expect { "the crate is on it", body = "crate", x = {-0.05, 0.05}, y = {top + 0.67, top + 0.71} }
