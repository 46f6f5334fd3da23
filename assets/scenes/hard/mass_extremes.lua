-- mass_extremes.lua - three stacks of equal boxes: of a microgram, of a kilogram, of a million tonnes.
-- Fails: thresholds in newtons or newton seconds, sleep by energy; avbd-demo2d #11, Avian #593 sink with density.
-- Right: mass drops out of it: all three stand the same.
scene { title = "Micrograms and megatonnes", duration = 4 }
local n = param("n", 10, 2, 40)
body { type = "static", box { 40, 1 }, at = {0, -0.5} }
for k, mass in ipairs { 1e-9, 1, 1e9 } do
    for i = 1, n do body { name = ("box%d_%d"):format(k, i), box { 1, 1 }, at = {k * 4 - 8, i - 0.5}, mass = mass } end
end
for k, what in ipairs { "micrograms", "kilograms", "megatonnes" } do
    expect { what .. " stand", always = true, body = ("box%d_%d"):format(k, n), x = {k * 4 - 8.001, k * 4 - 7.999},
             y = {(n - 0.5) * 0.99, n - 0.499} }
end
expect { "all the same", test = function()
    local off = 0
    for i = 1, n do
        local _, a = find("box1_" .. i):position()
        local _, b = find("box2_" .. i):position()
        local _, c = find("box3_" .. i):position()
        off = math.max(off, math.abs(a - b), math.abs(c - b))
    end
    return off <= 1e-4, off, 1e-4
end }
