-- skinny_box.lua - sticks 2 cm thin and 4 m long are thrown down at 150 m/s, level, upright and spinning ten turns a
-- second; the ground is a line. However they hit it, they stay above it.
scene { title = "Skinny boxes", duration = 5 }
camera { fit = {{-16, -1}, {22, 12}}, at = 0.15, trail = 0.1 }
body { type = "static", segment { {-60, 0}, {60, 0} }, segment { {-60, 0}, {-60, 40} }, segment { {60, 0}, {60, 40} } }
local n = 0
for i, angle in ipairs { 0, 0.3, 1.2, math.pi / 2 } do
    for k, spin in ipairs { 0, 60 } do
        n = n + 1
        body { name = "stick" .. n, box { 4, 0.02 }, at = {9 * (i - 1) - 12 + 4.5 * (k - 1), 8}, angle = angle, spin = spin,
               velocity = {0, -150}, density = 10, color = k, continuous = true, apart = "sticks" }
    end
end
expect { "no stick goes through the ground", always = true, body = "stick*", y = {0, 60}, x = {-60, 60} }
expect { "in the end they lie on it", body = "stick*", y = {0.008, 0.03} }
expect { "flat", test = function()
    local most = 0
    for i = 1, n do most = math.max(most, math.abs(math.sin(find("stick" .. i):angle()))) end
    return most < 0.02, most, 0.02
end }
