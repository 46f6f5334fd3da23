-- bath.lua - what floats, and how deep: blocks of six densities, a boat with a load, balls that are let go under water.
-- Shows: water, buoyancy by exact areas, which way up logs float, rest and sleep on the water.
-- lint: allow units: balls of a density of 1 pop up from under water
scene { title = "Bath", description = "As deep as its density; a square log lies flat only below 0.21 and above 0.79.", duration = 12 }
camera { fit = {{-9.4, -4.5}, {9.4, 2.6}}, at = 0.75 }
local tub = material { friction = 0.4, density = 2000 }
body { type = "static", box { 19, 0.5, at = {0, -4.25} }, box { 0.5, 5, at = {-9.25, -2} }, box { 0.5, 5, at = {9.25, -2} }, material = tub }
local water = water { name = "water", box { 18, 4 }, at = {0, -2} }

-- Logs, a little turned: they find how they want to float.
local ratios = { 0.9, 0.5, 0.15, 0.01 }
local logs = {}
for i, ratio in ipairs(ratios) do
    logs[i] = body { name = "log " .. ratio, box { 1, 1 }, density = 1000 * ratio, at = {-9.3 + 1.9 * i, 1.2 - ratio}, angle = 0.1,
                     color = i }
end

-- 3.2 m of hull of 0.2 and a crate of 0.5 on it.
local hull = body { name = "boat", polygon { {-1.6, 0.25}, {-1.1, -0.45}, {1.1, -0.45}, {1.6, 0.25} }, density = 200, at = {1.4, 0.4}, color = 5 }
local crate = body { name = "crate", box { 0.7, 0.7 }, density = 500, at = {1.4, 1.05}, color = 6 }

-- A duck: three shapes that float as one.
local duck = body { name = "duck", polygon { {-0.5, 0.1}, {-0.38, -0.2}, {0.38, -0.2}, {0.5, 0.1}, round = 0.1 }, circle { 0.24, at = {0.22, 0.45}, density = 60 }, polygon { {0.42, 0.52}, {0.68, 0.42}, {0.42, 0.36}, density = 60 },
                    polygon { {-0.3, 0.1}, {-0.75, 0.4}, {-0.1, 0.3}, density = 60 }, density = 220, at = {4.6, 0.8}, color = "#f2c230" }

local balls = {}
for i = 1, 5 do
    balls[i] = body { name = "ball" .. i, circle { 0.12 + 0.05 * i }, density = ({ 3000, 900, 500, 50, 1 })[i], at = {4.6 + 0.78 * i, -3.4},
                      color = 6 + i }
end

local function off(b, y) local _, now = b:position() return math.abs(now - y) end
-- s h of a box under water; of 0.15 flat, of 0.5 on its edge: the corner is at the surface.
expect { "the heavy log is as deep as it is dense", at = 12, test = function() local d = off(logs[1], 0.5 - 0.9) return d < 2e-3, d, 2e-3 end }
expect { "the log of a half floats on its edge", at = 12, test = function()
    local a = math.abs(logs[2]:angle()) % (math.pi / 2) return math.abs(a - math.pi / 4) < 0.02, a, math.pi / 4 end }
expect { "that of 0.15 lies flat", at = 12, test = function() local d = off(logs[3], 0.35) return d < 2e-3, d, 2e-3 end }
expect { "that of 0.01 lies on top", at = 12, test = function() local d = off(logs[4], 0.49) return d < 2e-3, d, 2e-3 end }
expect { "the stone sinks", at = 12, body = "ball1", y = {-4, -3.7} }
expect { "the others rise", at = 12, test = function()
    local low = 1
    for i = 2, 5 do low = math.min(low, select(2, balls[i]:position())) end
    return low > -0.3, low, -0.3
end }
expect { "the crate stays aboard", at = 12, body = "crate", y = {0.4, 1.5} }
expect { "the duck floats upright", at = 12, test = function() local a = math.abs(duck:angle()) return a < 0.5, a, 0.5 end }
expect { "nothing is ever thrown out", always = true, max_speed = 8 }
expect { "and all comes to rest", at = 12, max_speed = 0.05 }
