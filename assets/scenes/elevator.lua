-- elevator.lua - a house with a lift: somebody calls it, rides, pushes a crate out on the second floor,
-- goes up to the roof and all the way down again.
-- Shows: a character carried without lag, up and down, beside a dynamic crate that is; pushing.
scene { title = "Elevator", description = "A character and a crate ride a lift.", duration = 30 }
camera { fit = {{-8, -1.2}, {8, 12.6}}, at = 6.2, trail = 3 }

local wall, floor, steel = "#9aa5b1", "#6b7785", "#3d6f9f"
local storey = 3
for i = 0, 3 do
    local y = storey * i
    for side = -1, 1, 2 do
        body { type = "static", color = floor, box { 5.2, 0.3 }, at = {4 * side, y - 0.15} }
    end
end
body { type = "static", color = floor, box { 2.8, 0.3 }, at = {0, -0.65} }         -- the pit of the shaft
body { type = "static", color = wall, box { 0.3, 9.3 }, at = {-6.75, 4.35} }
body { type = "static", color = wall, box { 0.3, 9.3 }, at = {6.75, 4.35} }
body { name = "shelf", type = "static", color = "#c08a4a", box { 1.6, 0.12 }, at = {-4.4, 10.6}, one_way = {0, 1} }
body { name = "lamp", type = "static", sensor = true, color = "#f2c230", circle { 0.28 }, at = {-4.4, 12} }

local lift = body { name = "lift", type = "kinematic", color = steel, box { 2.6, 0.24 }, at = {0, -0.12} }
local crate = body { name = "crate", box { 0.9, 0.9 }, at = {0.7, 0.45}, mass = 30, color = "#b7793a" }
local hero = character { name = "hero", at = {-5, 0.91}, color = "#2f6fdd", character = { acceleration = 25 } }

-- The lift goes to a height with 2.5 m/s, and no more than 3 m/s^2.
local goal = 0
local function height() local _, y = lift:position(); return y + 0.12 end
local function is_there() return math.abs(height() - goal) < 0.002 end
local speed = 0
every_step(function()
    local way = goal - height()
    local wanted = math.min(2.5, math.sqrt(2 * 2.5 * math.abs(way)), math.abs(way) * 20)
    wanted = way > 0 and wanted or -wanted
    speed = speed + math.max(-0.05, math.min(0.05, wanted - speed))
    if math.abs(way) < 0.0005 then speed = 0 end
    lift:set_velocity(0, speed)
end)

local plan, now = {}, 1
local function plan_to(step) plan[#plan + 1] = step end
local function go(x)
    local side
    plan_to(function()
        local px = hero:position()
        side = side or (x > px and 1 or -1)
        hero:walk(2.5 * side)
        return (px - x) * side >= 0
    end)
end
local function ride(to)
    plan_to(function() hero:walk(0); goal = to * storey; return hero:speed() < 0.01 end)
    plan_to(function() return is_there() and math.abs(speed) < 0.01 end)
end

go(-0.7); ride(2)                                     -- with the crate to the second floor
go(3.2)                                               -- where it is pushed out
go(0); ride(3)
go(-4.3)                                              -- onto the roof, for the lamp
plan_to(function() hero:walk(0); return hero:on_ground() and hero:speed() < 0.01 and hero:jump(6.5) end)
plan_to(function() return hero:on_ground() end)
plan_to(function() return hero:drop() end)
plan_to(function() return hero:on_ground() end)
go(0); ride(0)
go(5)
plan_to(function() hero:walk(0); return false end)

-- How far the feet are from the floor of the lift while somebody rides.
local gap = 0
every_step(function()
    while plan[now] and plan[now]() do now = now + 1 end
    local on = hero:ground()
    if on and on:name() == "lift" then
        local _, y = hero:position()
        gap = math.max(gap, math.abs(y - 0.9 - height()))
    end
end)
on_enter { a = "lamp", b = "hero", function(lamp) lamp:set_color("#fff3b0"); score("lamps lit", 1) end }

expect { "feet stay on the floor of the lift", test = function() return gap < 0.0065, gap, 0.0065 end }
expect { "the crate is on the second floor", body = "crate", x = {2.5, 5}, y = 6.45, tolerance = 0.01 }
expect { "the hero comes home", body = "hero", x = {4.8, 5.3}, y = 0.906, tolerance = 0.002 }
expect { "the lamp is lit", score = "lamps lit", value = 1 }
