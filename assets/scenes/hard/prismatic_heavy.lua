-- prismatic_heavy.lua - a drawer in a drawer in a drawer, 6 deep, pulled out, with a weight in the last (Box2D: Multiple
-- Prismatic, Unstable Prismatic, which ended in infinities). Fails: soft rails bend. Right: rails are straight.
scene { title = "Drawers", duration = 5 }
local n, weight = param("n", 6, 1, 20), param("weight", 50, 1, 1e5)
local last = body { type = "static", box { 1, 1 }, at = {0, 0} }
for i = 1, n do
    local drawer = body { name = "drawer" .. i, box { 1, 0.4 }, at = {i * 0.8, 0}, mass = i == n and weight or 2,
                          apart = "chest" }
    prismatic { last, drawer, axis = {1, 0}, limits = {-0.1, 0.1} }
    last = drawer
end
expect { "the last sags by 1 % at most", from = 1, body = "drawer" .. n, y = {-0.008 * n, 0.008 * n} }
expect { "they stay level", from = 1, body = "drawer*", angle = {-0.02, 0.02} }
