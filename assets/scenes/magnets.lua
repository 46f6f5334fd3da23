-- magnets.lua - magnetic marbles and bars on a polished table, seen from above, find one another, snap together and sleep.
-- Shows: dipole, of bodies that are all sources of one mutual{} law on charge; softening, which bounds the pull of those that touch;
-- chains, bars side by side that point opposite ways: what has the least energy.
scene { title = "Magnets on a table", gravity = {0, 0}, duration = 20, dt = 1 / 120, seed = 3,
        description = "Thirty-six magnets, strewn at random, snap together into chains and come to rest." }
camera { fit = {{-4.3, -2.6}, {4.3, 2.6}}, at = 7 }
mutual { strength = param("strength", 1, 0.1, 4), on = "charge", softening = 0.1 }
body { name = "rim", type = "static", box { 8.4, 0.2, at = {0, 2.4} }, box { 8.4, 0.2, at = {0, -2.4} },
       box { 0.2, 4.6, at = {-4.1, 0} }, box { 0.2, 4.6, at = {4.1, 0} } }

-- The table rubs with 0.02 of the weight, against turning at 0.1 m.
local steel = material { density = 100, friction = 0.3, restitution = 0.2 }
local magnets, colors = {}, { "#d9dde2", "#c7cdd4", "#e3dccb" }
for i = 0, 8 do
    for j = 0, 3 do
        local bar, at = j == 1, { -3.2 + 0.8 * i + random(-0.15, 0.15), -1.5 + j + random(-0.2, 0.2) }
        local m = body { name = "magnet" .. #magnets, bar and box { 0.5, 0.18 } or circle { 0.15 }, at = at, material = steel,
                         angle = random(-3.1, 3.1), dipole = bar and 0.9 or 0.7, color = colors[#magnets % 3 + 1] }
        local rub = 0.02 * 9.81 * m:mass()
        friction { m, world, at = at, max_force = rub, max_torque = 0.1 * rub, hidden = true }
        magnets[#magnets + 1] = m
    end
end

local function count(what)
    local n = 0
    for _, m in ipairs(magnets) do n = n + (what(m) and 1 or 0) end
    return n
end
local function near(m)
    local x, y = m:position()
    for _, o in ipairs(magnets) do
        local ox, oy = o:position()
        if o ~= m and (ox - x) ^ 2 + (oy - y) ^ 2 < 0.51 ^ 2 then return true end
    end
end
expect { "strewn they stand alone", at = 0, test = function() local n = count(near) return n < 6, n, 6 end }
expect { "in the end they hang together", at = 20, test = function() local n = count(near) return n > 30, n, 30 end }
expect { "asleep", at = 20, test = function() local n = count(function(m) return m:awake() end) return n == 0, n, 0 end }
expect { "softening bounds what touches", always = true, max_speed = 8, max_penetration = 0.01 }
