-- near_miss.lua - what flies by is not touched: a box that passes 2 cm over the tip of a wedge at 100 m/s, a sliver that drops
-- past a post at 100 m/s, a tall box that comes down beside a ledge. Contacts that are made ahead of time must not push.
-- Without a touch each keeps to its parabola.
scene { title = "Near misses", duration = 1 }
camera { fit = {{-6, -12}, {30, 12}}, at = 0.14, trail = 0.2 }
body { type = "static", polygon { {0, 4}, {8, 4}, {8, 8} }, color = "#8792a2" }
body { type = "static", box { 0.4, 8 }, at = {14, 0}, color = "#8792a2" }
body { type = "static", box { 4, 1 }, at = {22, 0}, color = "#8792a2" }
local function free(name, x, y, vx, vy)
    exact { name, body = name, x = function(t) return x + vx * t end, y = function(t) return y + vy * t - 4.905 * t * t end }
    expect { ("the %s keeps to its parabola"):format(name), always = true, exact = name, tolerance = 1e-3 }
end
body { name = "slider", box { 1, 1 }, at = {-5, 8.61}, velocity = {100, 0}, color = 1, apart = "three" }
free("slider", -5, 8.61, 100, 0)
body { name = "sliver", polygon { {0, -2}, {0.1, 2}, {-0.1, 2} }, at = {14.31, 7}, velocity = {0, -100}, color = 2, apart = "three" }
free("sliver", 14.31, 7, 0, -100)
body { name = "tall", box { 0.2, 3 }, at = {24.105, 6}, velocity = {0, -30}, color = 3, apart = "three" }
free("tall", 24.105, 6, 0, -30)
expect { "nobody is turned", always = true, body = "*", spin = 0, tolerance = 1e-4 }
