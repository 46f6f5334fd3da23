-- wave_basin.lua - a paddle sends waves up a beach, over crates, balls and a stone; then what floats does so at its draft.
-- Shows: liquid{} that a kinematic body drives, bodies in its one system of pressures, its volume when it has calmed down.
scene { title = "Wave basin", duration = 16, description = "Six seconds of waves; then each floats as deep as its density says." }
camera { fit = {{-0.5, -0.5}, {10.5, 3.4}}, at = 4.2 }
local rock = material { density = 2400, friction = 0.6 }
body { type = "static", name = "floor", box { 11, 0.4, at = {5, -0.2} }, material = rock }
body { type = "static", box { 0.4, 4, at = {-0.3, 1.6} }, box { 0.4, 4, at = {10.3, 1.6} }, material = rock }
body { type = "static", name = "beach", polygon { {7.8, 0}, {10.1, 0}, {10.1, 2.0} }, material = rock }

-- It begins and ends gently, where it began.
local x0, reach, turns = 0.65, param("reach", 0.3, 0, 0.4), 0.7
local paddle = body { type = "kinematic", name = "paddle", box { 0.3, 2.6 }, at = {x0, 1.28}, color = 7 }
every_step(function(t)
    local x = paddle:position()
    local share = math.max(0, math.min(1, t, 6 - t))
    paddle:set_velocity((x0 + share * reach * math.sin(2 * math.pi * turns * t) - x) * 60, 0)
end)

local depth = 1.28
liquid { spacing = param("spacing", 0.08, 0.04, 0.16),
         polygon { {x0 + 0.15, 0}, {7.8, 0}, {7.8 + depth * 1.15, depth}, {x0 + 0.15, depth} } }

-- Half height, share of the water's density: where they are to end.
local floats = {
    { body { name = "crate 0.5", box { 1.2, 0.5 }, density = 500, at = {2.2, 1.8}, color = 1 }, 0.25, 0.5 },
    { body { name = "crate 0.3", box { 1.0, 0.6 }, density = 300, at = {4.9, 1.9}, color = 3 }, 0.3, 0.3 },
    { body { name = "ball 0.7", circle { 0.35 }, density = 700, at = {3.6, 2.0}, color = 2 }, 0.35, 0.7, true },
    { body { name = "ball 0.3", circle { 0.3 }, density = 300, at = {6.2, 1.8}, color = 4 }, 0.3, 0.3, true },
}
body { name = "stone", circle { 0.25 }, material = rock, at = {7.0, 1.8}, color = 6 }

-- Share of a disc of radius 1 below y.
local function disc(y) return (math.acos(-y) + y * math.sqrt(1 - y * y)) / math.pi end

local function draft(half, share, round)
    local low, high = -1, 1
    for _ = 1, 40 do
        local y = (low + high) / 2
        if (round and disc(y) or (1 + y) / 2) < share then low = y else high = y end
    end
    return half * (1 + low)
end

-- Water and what is displaced fill the basin, 7 m wide at the ground, so high.
local function level()
    local area = liquid_in(-1, -1, 11, 9) + math.pi * 0.25 ^ 2
    for _, f in ipairs(floats) do area = area + f[1]:mass() / 1000 end
    return (math.sqrt(49 + 4 * 0.575 * area) - 7) / (2 * 0.575)
end

-- Waves still run: the mean of the last four seconds.
every_step(function(t)
    for _, f in ipairs(floats) do
        if t > 12 then
            local _, y = f[1]:position()
            f.sum, f.count = (f.sum or 0) + level() - y + f[2], (f.count or 0) + 1
        end
    end
end)
for _, f in ipairs(floats) do
    expect { f[1]:name() .. " floats at its draft", at = 16, test = function()
        local found = f.sum / f.count
        local off = math.abs(found - draft(f[2], f[3], f[4]))
        return off < 0.05, found, draft(f[2], f[3], f[4])
    end }
end
-- Were it thicker or thinner than at first, its centre would lie elsewhere.
expect { "no volume is won or lost", at = 16, test = function()
    local area, _, _, _, y = liquid_in(-1, -1, 11, 9)
    local h, r = level(), 0.25
    local moment = 3.5 * h ^ 2 + 1.15 / 3 * h * h ^ 2 - math.pi * r ^ 2 * r
    for _, f in ipairs(floats) do
        moment = moment - f[1]:mass() / 1000 * (h - (f[4] and 0.45 or 0.5) * draft(f[2], f[3], f[4]))
    end
    local ratio = y * area / moment
    return math.abs(ratio - 1) < 0.02, ratio, 1
end }
expect { "the stone lies on the ground", at = 16, body = "stone", y = {0.2, 0.3} }
expect { "nothing is thrown out", always = true, test = function()
    return liquid_in(-0.1, -0.1, 10.1, 5) > 0.999 * liquid_in(-99, -99, 99, 99)
end }
