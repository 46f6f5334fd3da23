-- stick_slip.lua - a block of mass m on a floor, drawn by a spring k whose end goes at v: it sticks until the spring pulls by S = mu_s
-- m g, then slides: u'' = w^2 (K - u), K = mu_k m g, u(0) = S, u'(0) = k v, so u = K + A cos(w t - f), tan f = k v / (w (S - K)),
-- until it is as fast as the end again: after (pi + 2 f) / w, with u = 2 K - S whatever v. Period: that and 2 (S - K) / (k v).
-- Source: Rabinowicz, Friction and Wear of Materials; any textbook on friction oscillators. Hard: when it breaks away, which a
-- substep knows to its length.
-- Aim: 1e-3 m.
scene { title = "Stick and slip", duration = 4, description = "A block drawn by a spring sticks and slips." }
local g, m, k, v, stuck, slid = 9.81, 1, 100, 0.1, 0.5, 0.3
local S, K, w = stuck * m * g, slid * m * g, math.sqrt(k / m)
local rough = material { friction = stuck, kinetic_friction = slid }
body { name = "floor", type = "static", box { 6, 1 }, at = {0, -0.5}, material = rough }
local block = body { name = "block", box { 1, 0.25 }, at = {0, 0.125}, mass = m, material = rough, fixed_rotation = true, sleep = false }
local hand = body { name = "hand", type = "kinematic", circle { 0.05, sensor = true }, at = {2, 0.125}, velocity = {v, 0} }
distance { hand, block, at_a = {2, 0.125}, at_b = {0, 0.125}, spring = { stiffness = k } }
local A, f = math.sqrt((S - K) ^ 2 + (k * v / w) ^ 2), math.atan(k * v / w, S - K)
local slips, first = (math.pi + 2 * f) / w, S / (k * v)
local period = slips + 2 * (S - K) / (k * v)
exact { "place", body = "block", x = function(t)
    if t < first then return 0 end
    local into = math.fmod(t - first, period)
    local u = into < slips and K + A * math.cos(w * into - f) or 2 * K - S + k * v * (into - slips)
    return v * t - u / k
end }
expect { "five slips", exact = "place", tolerance = 0.0007 }
