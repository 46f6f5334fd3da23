-- fans.lua - fans: three hold balls up in glass tubes, a fourth swings and blows leaves about.
-- Shows: jets, which a kinematic body can turn, eddies; where a ball floats follows from the jet's law.
scene { title = "Fans", duration = 20, seed = 2,
        description = "Balls float where the jet has slowed down to their terminal speed; leaves go where the fan looks." }
camera { fit = {{-6.4, -0.5}, {11.4, 9.2}}, at = 7.5, trail = 0.5 }
body { name = "ground", type = "static", box { 100, 3 }, at = {10, -1.5} }

local WIDTH, RADIUS, DENSITY, AIR, DRAG = 0.35, 0.1, 28, 1.2, 1.8
local function hood(x)
    body { type = "static", polygon { {-0.42, 0}, {0.42, 0}, {0.3, 0.45}, {-0.3, 0.45} }, at = {x, 0}, collides = {}, color = "#6b7a8f" }
end

-- It floats where the axis has u: drag / 2 air (2/3) 2 r u^2 = m g, and u^2 = jet^2 6 width / x.
local glass = material { friction = 0 }
local square = DENSITY * math.pi * RADIUS ^ 2 * 9.81 / (DRAG / 2 * AIR * 2 / 3 * 2 * RADIUS)
local speeds = { 9.5, 11.5, 13.5 }
for i, speed in ipairs(speeds) do
    local x = -5.2 + 2.2 * (i - 1)
    hood(x)
    wind { box { 30, 2.1, at = {15, 0} }, at = {x, 0.45}, angle = math.pi / 2, jet = speed, jet_width = WIDTH, drag = DRAG, skin_drag = 0, name = "jet" .. i, category = "air" }
    body { type = "static", box { 0.05, 8.2, at = {x - 0.155, 4.7} }, box { 0.05, 8.2, at = {x + 0.155, 4.7} }, material = glass, color = "#a9c1d6" }
    body { name = "ball" .. i, circle { RADIUS }, at = {x, 0.45 + 0.8 * speed ^ 2 * 6 * WIDTH / square}, density = DENSITY, color = i }
    expect { "ball " .. i .. " floats where the jet is as fast as it falls", at = 20, test = function()
        local _, y = find("ball" .. i):position()
        local theory = 0.45 + speed ^ 2 * 6 * WIDTH / square
        return math.abs(y / theory - 1) < 0.04, y, theory
    end }
end

-- A fan on a stand that looks up and down.
body { type = "static", box { 0.14, 1.5, at = {0, 0.75} }, at = {1.6, 0}, collides = {}, color = "#6b7a8f" }
local fan = wind { name = "fan", type = "kinematic", box { 14, 9, at = {7, 0} }, at = {1.6, 1.5}, jet = 9, jet_width = 0.9, eddies = 0.8, eddy_length = 3, category = "air" }
local head = body { name = "head", type = "kinematic", polygon { {-0.3, -0.3}, {0, -0.45}, {0, 0.45}, {-0.3, 0.3} }, at = {1.6, 1.5}, collides = {}, color = "#4a5568" }
every_step(function()
    local spin = 0.9 * math.cos(1.3 * time())
    fan:set_spin(spin)
    head:set_spin(spin)
end)
local leaves = {}
for i = 1, 60 do
    leaves[i] = body { name = "leaf" .. i, polygon { {-0.12, 0}, {0, -0.03}, {0.12, 0}, {0, 0.03} }, density = 3, angle = random(0, 6),
                       at = {random(2.5, 8), random(0.3, 6)}, ignores = "leaf", category = "leaf",
                       color = i % 3 == 0 and "#d98a2b" or i % 3 == 1 and "#b5452c" or "#8aa33b" }
end
expect { "leaves are blown away from the fan", at = 6, test = function()
    local far = 0
    for _, leaf in ipairs(leaves) do far = far + leaf:position() / #leaves end
    return far > 8, far, 8
end }
-- Beyond the jet leaves fall freely: what blew them is how fast they go along. Eddies are 0.8 m/s, root mean square.
expect { "no leaf is blown faster than the jet and four of its eddies", always = true, test = function()
    local most = 0
    for _, leaf in ipairs(leaves) do most = math.max(most, math.abs((leaf:velocity()))) end
    return most < 9 + 4 * 0.8, most, 9 + 4 * 0.8
end }
