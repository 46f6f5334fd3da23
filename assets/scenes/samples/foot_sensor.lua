-- foot_sensor.lua - a jumper with a sensor for a foot hops over a row of tiles: the sensor says when it stands, and it jumps
-- only then. In the air it sees nothing; standing across a seam it sees two tiles.
scene { title = "Foot sensor", duration = 8 }
camera { fit = {{-2, -1.5}, {14, 5}}, at = 2, trail = 2 }
for i = 0, 15 do body { name = "tile" .. i, type = "static", box { 1, 1 }, at = {i - 1, -0.5}, category = "ground" } end
local hero = body { name = "hero", at = {0, 1}, fixed_rotation = true, color = 1,
                    capsule { 0.8, 0.3, at = {0, 0}, angle_deg = 90, material = material { friction = 0 } },
                    box { 0.4, 0.2, at = {0, -0.75}, sensor = true } }
local feet, jumps, highest, most = 0, 0, 0, 0
on_enter { a = "hero", b = "tile*", function() feet = feet + 1 end }
on_leave { a = "hero", b = "tile*", function() feet = feet - 1 end }
local v = 5
every_step(function(t)
    local _, y = hero:position()
    most = math.max(most, feet)
    highest = math.max(highest, y)
    if feet > 0 and math.abs(select(2, hero:velocity())) < 0.01 and jumps < 5 then
        hero:set_velocity(1.5, v)
        jumps = jumps + 1
    elseif feet > 0 and jumps == 5 and math.abs(select(2, hero:velocity())) < 0.01 then
        hero:set_velocity(0, select(2, hero:velocity()))
    end
    score("on tiles", feet)
end)
expect { "it jumps five times", test = function() return jumps == 5, jumps, 5 end }
expect { "as high as v^2 / (2 g)", test = function()
    local top = 0.7 + v * v / 2 / 9.81
    return math.abs(highest - top) < 0.06, highest, top
end }
expect { "it goes 2 v v_x / g with each flight", body = "hero", x = 5 * 2 * v * 1.5 / 9.81, tolerance = 0.3 }
expect { "at the end it stands on one or two tiles", score = "on tiles", value = {1, 2} }
