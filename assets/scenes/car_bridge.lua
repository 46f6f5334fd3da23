-- car_bridge.lua - a car with sprung wheels drives over a bridge of planks.
-- Shows: wheel joints with suspension and motor; a wheel that rolls turns by v = w r.
scene { title = "Car over a bridge", description = "Suspension, a motor, and a bridge that sags.", duration = 12 }
camera { fit = {{-9, -4.2}, {11, 4}}, at = 4.4 }

local road = material { name = "road", friction = 1 }
local rubber = material { name = "rubber", density = 60, friction = 1.2 }
local wood = material { name = "wood", density = 60, friction = 0.9 }

-- Two banks with a gap of 12 m between them, a bump before it and a ramp after it.
local banks = body { name = "banks", type = "static", material = road,
    chain {{-30, 0}, {-9, 0}, {-8, 0.25}, {-7, 0.25}, {-6, 0}, {-4, 0}, {-4, -3.5}, {8, -3.5}, {8, 0}, {12, 0},
           {15, 0.5}, {60, 0.5}} }

local planks = 12
local last = banks
for i = 1, planks do
    local x = -4 + (i - 0.5)
    local plank = body { name = "plank" .. i, box { 0.96, 0.16 }, at = {x, -0.08}, material = wood, color = "#a9744f" }
    revolute { last, plank, at = {x - 0.5, -0.08}, name = "link" .. i }
    last = plank
end
revolute { last, banks, at = {8, -0.08}, name = "link" .. planks + 1 }

-- The car: a body and two wheels on struts; the motor is on the rear wheel.
local r, speed = 0.45, 4.5 -- [m] wheel, [m/s] wanted
local car = body { name = "car", at = {-14, 0.95}, density = 45, color = "#cf6e73",
    polygon {{-1.8, -0.2}, {1.8, -0.2}, {1.9, 0.15}, {1.1, 0.3}, {-1.8, 0.3}}, polygon {{-1.5, 0.3}, {0.7, 0.3}, {0.2, 0.8}, {-1.1, 0.8}} }
local function wheel_at(name, x, motor)
    local hub = body { name = name, circle { r }, at = {-14 + x, r}, material = rubber, color = "#4a5568" }
    return wheel { car, hub, name = name, axis = {0, 1}, limits = {-0.25, 0.3}, motor = motor,
                   spring = { frequency = 2.5, damping = 0.7 } }
end
local rear = wheel_at("rear", -1.2, { speed = -speed / r, torque = 400 })
wheel_at("front", 1.2)

-- Where the road is even, the car has the speed at which its wheels roll.
at(11, function() score("speed", car:speed()) end)

expect { "the car gets across", body = "car", x = {16, 60} }
expect { "it rolls at v = w r", score = "speed", value = speed, tolerance = 0.05 * speed }
expect { "it stays upright", always = true, body = "car", angle = {-0.5, 0.5} }
expect { "the wheels stay on their struts", always = true, joint = "rear", joint_value = {-0.27, 0.32} }
expect { "the bridge holds together", always = true, max_joint_error = 0.05 }
