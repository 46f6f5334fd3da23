-- mass_densities.lua - discs in a bin, one in ten a million times denser (osmium in foam).
-- Fails: the dense ones fall through the light: 59 cm overlap here, 78 cm in Box2D. Right: nothing overlaps by a tenth
-- of a radius once it lies, all stay in the bin, and the dense ones low: they have no more energy than they fell with. A light
-- disc may fly high: two of them between dense ones, a little off the line, buckle out at the speed that closes on them over
-- the tangent of what they are off it; hence the walls.
scene { title = "Densities 1e6 : 1", duration = 6, seed = 5 }
local n, ratio = param("n", 60, 2, 400), param("ratio", 1e6, 1, 1e7)
body { type = "static", box { 10, 1, at = {0, -0.5} }, box { 1, 400, at = {-4, 199} }, box { 1, 400, at = {4, 199} } }
local discs, dense, r = {}, {}, 0.4
for i = 0, n - 1 do
    discs[i + 1] = body { name = "disc" .. i, circle { r }, density = i % 10 == 9 and ratio or 1,
                          at = {(i % 6 - 2.5) * 1.1 + random(-0.1, 0.1), 0.5 + (i // 6) * 0.9} }
    dense[#dense + 1] = i % 10 == 9 and discs[i + 1] or nil
end
local top = 0.5 + (n // 6) * 0.9
local function overlap()
    local most = 0
    for i = 1, n do
        local xi, yi = discs[i]:position()
        for j = i + 1, n do
            local xj, yj = discs[j]:position()
            most = math.max(most, 2 * r - math.sqrt((xi - xj) * (xi - xj) + (yi - yj) * (yi - yj)))
        end
    end
    return most
end
expect { "nobody overlaps by a tenth of a radius", test = function() local d = overlap() return d <= 0.1 * r, d, 0.1 * r end }
expect { "nobody leaves the bin", always = true, body = "disc*", x = {-3.5, 3.5}, y = {0, 399} }
expect { "the dense are not thrown up", always = true, test = function()
    local most = 0
    for _, d in ipairs(dense) do most = math.max(most, select(2, d:position())) end
    return most <= top, most, top
end }
