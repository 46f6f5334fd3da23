-- heavy_on_light.lua - boxes of 10, 100, 1,000 and 10,000 kg each on one of 1 kg: after 5 s they lie where they were put.
-- Source: statics. Hard: sweeps over contacts gain a digit in about 2.3 R sweeps, R the ratio of masses.
-- Aim: 1e-3 m at 100 : 1 and above.
-- lint: allow mass-ratio: that is what it asks about
scene { title = "Heavy on light", duration = 5, description = "Heavy boxes on light ones." }
local m = material { friction = 0.6 }
body { name = "ground", type = "static", box { 30, 1 }, at = {0, -0.5}, material = m }
for i, ratio in ipairs { 10, 100, 1000, 10000 } do
    local x = 4 * i - 10
    body { name = "light" .. ratio, box { 1, 1 }, at = {x, 0.5}, mass = 1, material = m, sleep = false }
    local name = ratio .. " kg"
    body { name = name, box { 1, 1 }, at = {x, 1.5}, mass = ratio, material = m, sleep = false, color = i }
    exact { name, body = name, x = function() return x end, y = function() return 1.5 end }
end
expect { "10 : 1", exact = "10 kg", tolerance = 0.0041 }
expect { "100 : 1", exact = "100 kg", tolerance = 1e-3 }
expect { "1,000 : 1", exact = "1000 kg", tolerance = 1e-3 }
expect { "10,000 : 1", exact = "10000 kg", tolerance = 1e-3 }
