-- platformer.lua - a level played by a script: a hill, stairs, a crate pushed into a gap, a platform
-- that swings over a chasm, planks to be jumped through from below, a lift to the flag.
-- Shows: a kinematic character that walks, climbs, jumps, rides, pushes and drops; one-way planks; coins
-- as sensors.
scene { title = "Platformer", description = "A character plays a level.", duration = 33 }
camera { fit = {{-3, -2.6}, {50, 12}}, at = 20.85, trail = 4 }

-- The land. Tops are green, what holds them up is earth.
local earth, grass, stone, plank, steel = "#8a6b4a", "#5f9e4a", "#8792a2", "#c08a4a", "#4f6d8f"
local function land(x0, x1, top)
    body { type = "static", color = earth, box { x1 - x0, 3 + top }, at = {(x0 + x1) / 2, (top - 3) / 2} }
    body { type = "static", color = grass, box { x1 - x0, 0.2 }, at = {(x0 + x1) / 2, top - 0.1} }
end
land(-3, 8, 0)
body { type = "static", color = earth, outline { {8, -3}, {14, -3}, {14, 1.6}, {12, 1.6}, {8, -0.2} } }
body { type = "static", color = grass, polygon { {8, -0.2}, {12, 1.6}, {12, 1.8}, {8, 0} },
       polygon { {12, 1.6}, {14, 1.6}, {14, 1.8}, {12, 1.8} } }
for i = 1, 4 do -- stairs of 0.4 m
    body { type = "static", color = stone, box { 0.6, 4.8 - 0.4 * i }, at = {13.7 + 0.6 * i, (-1.2 - 0.4 * i) / 2} }
end
land(16.4, 21.5, 0.2)
body { type = "static", color = earth, box { 1.5, 2.2 }, at = {22.25, -1.9} } -- the floor of the gap
land(23, 27, 0.2)
land(34, 42, 0.2)
body { type = "static", color = earth, box { 5, 9 }, at = {47.5, 1.5} }
body { type = "static", color = grass, box { 5, 0.2 }, at = {47.5, 6.1} }

local crate = body { name = "crate", box { 1, 1 }, at = {19, 0.7}, mass = 40, color = "#b7793a" }
local swing = body { name = "swing", type = "kinematic", color = steel, box { 2.2, 0.25 }, at = {28.4, 0.075} }
local lift = body { name = "lift", type = "kinematic", color = steel, box { 2.4, 0.25 }, at = {43.4, 0.075} }
for i, x in ipairs { 36.4, 38.8, 36.4 } do
    body { name = "plank" .. i, type = "static", color = plank, box { 2.2, 0.2 }, at = {x, 0.1 + 1.7 * i},
           one_way = {0, 1} }
end
body { name = "pole", type = "static", color = "#d8dee9", box { 0.1, 3 }, at = {48.6, 7.7}, sensor = true }
body { name = "flag", type = "static", color = "#d64545", polygon { {0, 0}, {1, 0.35}, {0, 0.7} },
       at = {48.65, 8.4}, sensor = true }

-- Coins are sensors: they stop nobody and vanish when the hero is there.
local coins = 0
local function coin(x, y)
    coins = coins + 1
    body { name = "coin" .. coins, type = "static", sensor = true, color = "#f2c230", circle { 0.28 }, at = {x, y} }
end
for i = 0, 3 do coin(9 + i, 1.2 + 0.45 * i) end
coin(24, 2.6); coin(25, 2.6)
coin(30.2, 1.4)
for i = 1, 3 do coin(i == 2 and 39.4 or 35.8, 1.0 + 1.7 * i) end
coin(40.6, 0.9)
coin(46.4, 7.2)

local hero = character { name = "hero", at = {-1.5, 0.91}, color = "#2f6fdd",
                         character = { acceleration = 30, air_acceleration = 20, step_height = 0.5 } }

score("coins", 0)
on_enter { a = "coin*", b = "hero", function(it)
    it:destroy()
    score("coins", score("coins") + 1)
end }

-- What the hero does, one thing after the other.
local plan, now = {}, 1
local function plan_to(step) plan[#plan + 1] = step end
local function go(x, leap) -- to x; on the way it jumps where it is told to
    local side
    plan_to(function()
        local px = hero:position()
        side = side or (x > px and 1 or -1)
        hero:walk(4 * side)
        if leap and (px - leap.at) * side >= 0 then
            hero:jump(leap.speed)
            leap = nil
        end
        return (px - x) * side >= 0
    end)
end
local function stand(done) plan_to(function() hero:walk(0); return done() end) end
local function jump(speed)
    plan_to(function() hero:walk(0); return hero:jump(speed) end)
    plan_to(function() return not hero:on_ground() end) -- the step after
end
local function landed() return hero:on_ground() end
local function settled() return hero:on_ground() and hero:speed() < 0.05 end

go(18)                                                -- hill, coins, stairs
plan_to(function() hero:walk(2); return (crate:position()) > 21.6 end)
stand(function() local _, y = crate:position(); return y < -0.2 and crate:speed() < 0.05 end)
go(26.2, { at = 23.6, speed = 6 })                    -- over the crate, two coins in the air
stand(function() local x, v = swing:position(), swing:velocity(); return x < 28.6 and v > 0 end)
go(28.9)                                              -- aboard
stand(function() return (swing:position()) > 32.5 end)
go(36.4)
stand(settled); jump(6.6); stand(settled)             -- up through the planks
go(35.9)
go(38.8, { at = 37.0, speed = 6.6 })
stand(settled); go(39.3)
go(36.4, { at = 38.2, speed = 6.6 })
stand(settled); go(35.9)
for _ = 1, 2 do                                       -- and down through them
    stand(settled)
    plan_to(function() return hero:drop() end)
end
stand(settled)
go(43.4)
local ride = 0
plan_to(function() ride = time(); hero:walk(0); return true end)
stand(function() local _, y = lift:position(); return y > 6.05 end)
go(48)
stand(function() return false end)

-- Both platforms know when somebody is there; they are moved by their velocity.
every_step(function(t)
    swing:set_velocity(1.9 * math.sin(0.9 * t), 0)
    local _, y = lift:position()
    local up = ride > 0 and t > ride + 0.5
    lift:set_velocity(0, up and math.max(0, math.min(2, 4 * (6.075 - y), 4 * (t - ride - 0.5))) or 0)
    while plan[now] and plan[now]() do now = now + 1 end
end)

expect { "all coins are found", score = "coins", value = coins }
expect { "the hero is at the flag", body = "hero", x = {47.9, 48.35}, y = 7.106, tolerance = 0.3 }
expect { "the crate fills the gap", body = "crate", x = {21.9, 22.6}, y = {-0.35, -0.25} }
expect { "nothing is pressed into anything", always = true, max_penetration = 0.03 }
