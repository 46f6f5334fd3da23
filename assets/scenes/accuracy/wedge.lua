-- wedge.lua - a block slides down a free wedge without friction: the wedge goes back with m g sin cos / (M + m sin^2), the
-- block's centre moves as momentum and the slope demand.
-- Source: Landau and Lifshitz, Mechanics; Goldstein ch. 1. Hard: two bodies that only a contact moves.
-- Aim: 1e-3 m.
scene { title = "Block and wedge", duration = 1, description = "A block slides down a wedge that slides away." }
local g, angle, mass, big = 9.81, math.pi / 6, 1, 3
local c, s = math.cos(angle), math.sin(angle)
local ice = material { friction = 0 }
body { name = "ground", type = "static", box { 60, 1 }, at = {0, -0.5}, material = ice }
body { name = "wedge", polygon { {0, 0}, {6, 0}, {0, 6 * math.tan(angle)} }, mass = big, material = ice,
        fixed_rotation = true, color = 1 }
local x, y = 1 + 0.25 * s, (6 - 1) * math.tan(angle) + 0.25 * c
body { name = "block", box { 0.5, 0.5 }, at = {x, y}, angle = -angle, mass = mass, material = ice, fixed_rotation = true,
        color = 2 }
local back = mass * g * s * c / (big + mass * s * s)
local ax = back * big / mass
local ay = -math.tan(angle) * (ax + back)
exact { "wedge", body = "wedge", x = function(t) return -back * t * t / 2 end }
exact { "block", body = "block", x = function(t) return x + ax * t * t / 2 end, y = function(t) return y + ay * t * t / 2 end }
expect { "the wedge", exact = "wedge", tolerance = 2.4e-05 }
expect { "the block", exact = "block", tolerance = 0.00015 }
