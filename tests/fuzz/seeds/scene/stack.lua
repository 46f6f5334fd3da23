scene{ dt = 0.01, duration = 1, y = "up", solver = "soft" }
local m = material{ friction = 0.5, restitution = 0.2, density = 2 }
body{ type = "static", box{10, 1}, chain{{-5, 1}, {0, 0.6}, {5, 1}} }
for i = 1, 5 do body{ name = "b" .. i, box{1, 1, round = 0.01}, at = {0, i}, material = m } end
body{ circle{0.5, at = {1, 0}}, capsule{1, 0.2}, regular(5, 0.3), at = {3, 3}, color = "#ff0000" }
body{ outline{{0, 0}, {2, 0}, {2, 2}, {1, 0.5}, {0, 2}}, at = {-3, 4}, spin = 1 }
camera{ fit = {{-5, 0}, {5, 5}} }
expect{ "x", at = 0.5, body = "b1", y = {0, 2}, max_speed = 5 }
