-- magnet_crane.lua - a crane's electromagnet picks scrap from a heap, carries it over a wagon and drops it.
-- Shows: dipole of a body that a handler switches, mutual{} between magnets, a trolley and a hoist that a handler drives.
-- Scrap has dipoles of its own: what the magnet holds hangs below it, and its hoist carries the weight of all.
scene { title = "Magnet crane", duration = 49, seed = 5, substeps = 8,
        description = "An electromagnet, a trolley and a hoist load a wagon with scrap." }
camera { fit = {{-6.6, -0.6}, {6.6, 6.6}}, at = 7 }
local g = 9.81
local steel = material { name = "steel", density = 60, friction = 0.5 }
body { name = "yard", type = "static", box { 16, 0.6, at = {0, -0.3} }, color = "#9a8f80" }
body { name = "pit", type = "static", box { 0.15, 0.7, at = {-5.3, 0.35} }, box { 0.15, 0.7, at = {-1.7, 0.35} }, color = "#7b8794" }
body { name = "gantry", type = "static", box { 12.4, 0.3, at = {0, 6} }, box { 0.3, 5.9, at = {-6, 2.95} }, box { 0.3, 5.9, at = {6, 2.95} },
       collides = {}, color = "#d69e2e" }
body { name = "wagon", type = "static", box { 3.6, 0.15, at = {3.5, 0.45} }, box { 0.15, 1.3, at = {1.7, 1} }, box { 0.15, 1.3, at = {5.3, 1} },
       circle { 0.3, at = {2.5, 0.3} }, circle { 0.3, at = {4.5, 0.3} }, color = "#4a6f8f" }
mutual { strength = 1, on = "charge", softening = 0.2 }

local scrap, colors = {}, { "#8c6a4f", "#6f7780", "#a3573f", "#7d8a6a" }
for i = 1, 21 do
    local shape = i % 3 == 0 and box { 0.42, 0.16 } or i % 3 == 1 and regular(5, 0.17) or circle { 0.15 }
    local row = (i - 1) // 7
    scrap[i] = body { name = "scrap" .. i, shape, at = {-5 + 0.44 * ((i - 1) % 7) + 0.25 + random(-0.02, 0.02), 0.3 + 0.45 * row}, material = steel,
                      dipole = 0.1, dipole_angle = math.pi / 2, angle = random(-0.1, 0.1), color = colors[i % 4 + 1], label = " " }
end
local trolley = body { name = "trolley", box { 0.9, 0.25 }, at = {-3.5, 5.7}, mass = 300, collides = {}, color = "#5b8fbf" }
local rail = prismatic { trolley, axis = {1, 0}, limits = {-1.5, 8}, motor = { speed = 0, force = 6000 }, name = "rail" }
local magnet = body { name = "magnet",
                      polygon {{-0.4, -0.12}, {0.4, -0.12}, {0.5, 0.05}, {0.3, 0.2}, {-0.3, 0.2}, {-0.5, 0.05}}, at = {-3.5, 3.4}, mass = 60,
                      dipole = 0, dipole_angle = math.pi / 2, damping = 0.3, color = "#c0504a" }
local strong = param("strong", 130, 0, 400) -- [C m]: at 1 m it pulls a piece with nearly twice its weight
local length, ropes = 2, {}
for side = -1, 1, 2 do
    ropes[#ropes + 1] = distance { trolley, magnet, at_a = {-3.5 + side * 0.3, 5.6}, at_b = {-3.5 + side * 0.3, 3.6}, limits = {0, length} }
end

-- A round: down to the heap, current on, up, over the wagon, current off, back to where most of the rest lies.
local round, ride, over, way, target = 17.5, 5.6, 3.5, 0, 4.4 -- [s], [s]: twice the time of a swing, [m]
local function rest()
    local n, sum, top = 0, 0, 0
    for _, s in ipairs(scrap) do
        local x, y = s:position()
        if x < -1 then n, sum, top = n + 1, sum + x, math.max(top, y) end
    end
    return n > 0 and sum / n or -3.5, top
end
local function hanging()
    local n, mass = 0, 0
    for _, s in ipairs(scrap) do
        local _, y = s:position()
        if y > 2 then n, mass = n + 1, mass + s:mass() end
    end
    return n, mass
end
local lifted, kept, off_by = 0, 0, 0
every_step(function(t)
    local p = t % round
    local wanted = p < 2.6 and target or 2
    length = length + math.max(-1.2 / 60, math.min(1.2 / 60, wanted - length))
    for _, rope in ipairs(ropes) do rope:set_limits(0, length) end
    local u = (p < 11.7 and p - 5 or p - 11.7) / ride
    rail:set_motor_speed(u > 0 and u < 1 and 2 * way / ride * math.sin(math.pi * u) ^ 2 or 0)
end)
for trip = 0, 2 do
    local t0 = trip * round
    at(t0 + 2.1, function() magnet:set_dipole(strong) end)
    at(t0 + 4.95, function() way = over - trolley:position() lifted = lifted + hanging() end)
    at(t0 + 11.15, function()
        local n, mass = hanging()
        kept = kept + n
        off_by = math.max(off_by, math.abs((ropes[1]:reaction() + ropes[2]:reaction()) / ((60 + mass) * g) - 1))
    end)
    at(t0 + 11.2, function() magnet:set_dipole(0) end)
    at(t0 + 11.65, function() local x, top = rest() way = x - trolley:position() target = 5.5 - top end)
end

local function loaded()
    local n = 0
    for _, s in ipairs(scrap) do
        local x, y = s:position()
        n = n + (x > 1.8 and x < 5.2 and y > 0.5 and y < 2 and 1 or 0)
    end
    return n
end
expect { "two thirds of the scrap or more lie in the wagon", test = function() local n = loaded() return n > 2 / 3 * #scrap, n, 2 / 3 * #scrap end }
expect { "what is lifted is carried all the way", test = function() return kept == lifted and kept > 0, kept, lifted end }
expect { "the ropes carry the weight of magnet and scrap", test = function() return off_by < 0.04, off_by, 0.04 end }
expect { "joints hold together", always = true, max_joint_error = 0.03 } -- ropes are wound by 0.02 m a step
expect { "at rest nothing is pressed together", max_penetration = 0.01 }
