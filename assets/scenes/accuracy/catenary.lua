-- catenary.lua - 20 equal links hang between two nails in equilibrium: tan(angle of link k) = (k - 10.5) w / H. They stay,
-- and the nails bear H and 10 w.
-- Source: Bernoulli, Leibniz, Huygens 1691, for links. Hard: small forces across long rows of joints.
-- Aim: 1e-3 m, 1e-3 of the force.
scene { title = "Hanging chain", duration = 4, description = "A chain of links hangs in its curve." }
local g, n, l, across = 9.81, 20, 0.5, 4 -- across: H / w
local x, y, last, first = 0, 0, world, nil
local places = {}
for k = 1, n do
    local angle = math.atan((k - (n + 1) / 2) / across)
    local c, s = math.cos(angle), math.sin(angle)
    places[k] = { x + l / 2 * c, y + l / 2 * s }
    local link = body { name = "link" .. k, box { l, 0.04 }, at = places[k], angle = angle, mass = 1, apart = "chain",
            sleep = false }
    local hinge = revolute { last, link, at = {x, y} }
    first, last = first or hinge, link
    x, y = x + l * c, y + l * s
end
revolute { last, world, at = {x, y} }
exact { "curve", unit = "m", value = function() return 0 end, measure = function()
    local worst = 0
    for k = 1, n do
        local px, py = find("link" .. k):position()
        px, py = px - places[k][1], py - places[k][2]
        worst = math.max(worst, math.sqrt(px * px + py * py))
    end
    return worst
end }
local force = g * math.sqrt(across * across + n * n / 4)
exact { "force", scale = force, from = 2, measure = function() return first:reaction() end, value = function() return force end }
expect { "the curve", exact = "curve", tolerance = 0.012 }
expect { "the nail's force", exact = "force", tolerance = 0.0035 }
