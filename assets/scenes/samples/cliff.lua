-- cliff.lua - boxes, capsules and discs are thrown along a ledge and over its edge. The discs and the fast ones fall to
-- the ground below; friction stops the slow box at v^2 / (2 mu g). Nobody is caught in the cliff.
scene { title = "Cliff", duration = 6 }
camera { fit = {{-9, -1}, {16, 7}}, at = 1.1, trail = 1 }
local rock = material { friction = 0.6 }
body { type = "static", material = rock, color = "#8792a2", box { 60, 1, at = {10, -0.5} }, box { 8, 4, at = {-4, 2} },
       box { 1, 8, at = {-8.5, 4} }, box { 1, 3, at = {25, 1.5} } }
local wood = material { friction = 0.6, rolling_resistance = 0.01 }
body { name = "slow", box { 0.6, 0.6 }, at = {-6.5, 4.3}, velocity = {4, 0}, material = wood, color = 1 }
body { name = "fast", box { 0.6, 0.6 }, at = {-2.5, 4.3}, velocity = {8, 0}, material = wood, color = 2 }
body { name = "capsule", capsule { 0.4, 0.25 }, at = {-5, 4.25}, velocity = {9, 0}, material = wood, color = 3 }
body { name = "disc1", circle { 0.3 }, at = {-1.2, 4.3}, velocity = {4, 0}, material = wood, color = 4 }
body { name = "disc2", circle { 0.3 }, at = {-0.5, 4.3}, velocity = {2, 0}, material = wood, color = 4 }
local way = 16 / (2 * 0.6 * 9.81)
expect { "friction stops the slow box", body = "slow", x = -6.5 + way, y = {4.28, 4.31}, tolerance = 0.04 }
expect { "what is over the edge lies below", body = "disc*", x = {0.2, 24.3}, y = {0.28, 0.305} }
expect { "so does the fast box", body = "fast", x = {0.2, 24.3}, y = {0.28, 0.31} }
expect { "so does the capsule, be it against a disc", body = "capsule", x = {0.2, 24.3}, y = {0.23, 0.46} }
expect { "nothing sinks", always = true, max_penetration = 0.03 }
