-- projectile.lua - a shot bursts where it hits: its contact, the moment it is told, makes a blast and takes it out of the
-- world. The wall that it hits falls; a wall behind it, out of the blast's reach, stands.
scene { title = "Bursting shot", duration = 5 }
camera { fit = {{-10, -1}, {14, 7}}, at = 0.55, trail = 0.4 }
body { name = "ground", type = "static", box { 80, 1 }, at = {0, -0.5} }
for i = 1, 8 do
    body { name = "near" .. i, box { 0.5, 0.5 }, at = {2, 0.5 * i - 0.25}, density = 20, color = 1 }
    body { name = "far" .. i, box { 0.5, 0.5 }, at = {11, 0.5 * i - 0.25}, density = 20, color = 2 }
end
local where
local v, g = {24, 4}, 9.81
body { name = "shot", circle { 0.15 }, at = {-9, 2}, velocity = v, density = 20, color = "#d64545" }
on_contact { a = "shot", function(shot, it, c)
    where = { c.x, c.y, time(), it:name() }
    blast { at = {c.x, c.y}, radius = 2, impulse = 20, falloff = 1 }
    shot:destroy()
end }
-- It flies (1.75 - 0.15 + 9) m to the wall: at y0 + vy t - g t^2 / 2.
local t = (2 - 0.25 - 0.15 + 9) / v[1]
expect { "it hits the near wall after d / v", at = 1, test = function()
    local off = math.abs(where[3] - t) return off < 2 / 60 and where[4]:sub(1, 4) == "near", where[3], t
end }
expect { "at the height of its parabola", at = 1, test = function()
    local y = 2 + v[2] * t - g * t * t / 2
    return math.abs(where[2] - y) < 0.2, where[2], y
end }
expect { "it is gone", at = 1, body = "shot*", count = 0 }
expect { "the near wall falls", body = "near8", y = {0, 2} }
expect { "the far wall stands", body = "far8", y = {3.7, 3.76} }
