-- net_catch.lua - a net held by two posts catches crates that fall.
-- Shows: cloth{} as a net of threads, two-way with bodies; nothing tears, and no crate passes.
scene { title = "Net", description = "A net of threads catches falling crates.", duration = 8 }
camera { fit = {{-4, -1}, {4, 6}}, at = 2.5 }

local rock = material { name = "rock", friction = 0.8 }
body { name = "ground", type = "static", material = rock, box { 9, 1, at = {0, -0.5} },
       box { 0.3, 4, at = {-3.15, 2} }, box { 0.3, 4, at = {3.15, 2} } }

local net = cloth { at = {0, 3.85}, size = {6, 0.3}, columns = 24, rows = 2, hold = "corners", mass = 6, stiffness = 1e5, damping = 100,
                    radius = 0.12, friction = 0.8, drag = 2, break_strain = 0.5, color = "#4f6fa8" }
local crates = 6
for i = 1, crates do
    local r = 0.22 + 0.03 * (i % 3)
    body { name = "crate" .. i, i % 2 == 0 and circle { r } or box { 2 * r, 2 * r }, at = {0.5 * (i - 3.5), 4.6 + 0.5 * (i % 3)}, mass = 8, material = rock, damping = 1 }
end
local most = 0
every(1 / 60, function() most = math.max(most, net:measure().strain) end)
expect { "no crate passes the net", always = true, body = "crate*", y = {0.8, 8}, x = {-3, 3} }
expect { "the net is stretched, and holds", at = 8, test = function() return net:measure().torn == 0 and most > 0.02 and most < 0.5, most, 0.5 end }
expect { "the crates lie still", at = 8, max_speed = 0.05 }
