-- gears_spinning.lua - a train of eight gears 1 : 2, driven at 600 turns a minute, and stopped.
-- Fails: gears that are held by velocity alone drift; angles that wrap slip a tooth. Right: no gear ever slips.
scene { title = "Gear train", gravity = {0, 0}, duration = 6 }
local n, rpm = param("n", 8, 2, 30), param("rpm", 600, 1, 6000)
local wheels, hinges = {}, {}
for i = 1, n do
    wheels[i] = body { name = "wheel" .. i, circle { i % 2 == 1 and 0.5 or 1 }, at = {i * 1.5, 0}, mass = i % 2 == 1 and 1 or 4,
                       apart = "train" }
    hinges[i] = revolute { wheels[i], at = {i * 1.5, 0} }
    if i > 1 then gear { hinges[i - 1], hinges[i], ratio = i % 2 == 1 and 0.5 or 2 } end
end
hinges[1]:set_motor(0, 1e4)
every_step(function(t) hinges[1]:set_motor((t < 3 and math.min(t, 1) or math.max(0, 4 - t)) * rpm * 2 * math.pi / 60, 1e4) end)
local slip = 0
every_step(function()
    for i = 2, n do -- odd wheels are half as large and turn twice as far, every other one backwards
        local wanted = -hinges[i - 1]:value() * (i % 2 == 1 and 2 or 0.5)
        slip = math.max(slip, math.abs(hinges[i]:value() - wanted))
    end
end)
expect { "no gear slips by a degree", test = function() return slip <= 0.0175, slip, 0.0175 end }
expect { "the first turned as driven", test = function()
    local off = math.abs(hinges[1]:value() - rpm * 2 * math.pi / 60 * 3)
    return off <= 2, off, 2
end }
expect { "no axle moves by 5 mm", always = true, max_joint_error = 0.005 }
