-- driving.lua - a car of 3 m with sprung, driven wheels goes over rolling hills, a seesaw and a row of boxes, and arrives. It
-- does not turn over, and its wheels do not leave their struts.
scene { title = "Driving", duration = 16 }
camera { fit = {{-6, -3}, {56, 14}}, at = 8, trail = 4 }
local road = material { friction = 1 }
local points = { {-12, 4}, {-8, 0} }
for i = 0, 40 do points[#points + 1] = { 0.5 * i, i == 40 and 0 or 0.6 * (1 - math.cos(2 * math.pi * i / 20)) } end
points[#points + 1] = {90, 0}
points[#points + 1] = {90, 6}
body { name = "road", type = "static", chain(points), material = road }
local plank = body { name = "seesaw", box { 8, 0.2 }, at = {27, 0.8}, angle = 0.17, density = 20, material = road, color = 3 }
revolute { plank, at = {27, 0.8}, limits = {-0.35, 0.05} }
for i = 1, 4 do body { name = "box" .. i, box { 0.5, 0.5 }, at = {38 + 1.5 * i, 0.25}, density = 5, color = 4 } end
local car = body { name = "car", polygon { {-1.6, -0.3}, {1.6, -0.3}, {1.6, 0.1}, {0.5, 0.6}, {-1, 0.6}, {-1.6, 0.2} }, at = {-5, 0.9}, density = 60, color = 1 }
for i, x in ipairs { -1, 1 } do
    local tyre = body { name = "wheel" .. i, circle { 0.4 }, at = {-5 + x, 0.42}, density = 60, material = material { friction = 1.5 }, color = 2 }
    wheel { car, tyre, at = {-5 + x, 0.42}, axis = {0, 1}, spring = { frequency = 4, damping = 0.7 }, limits = {-0.25, 0.25}, name = "strut" .. i,
            motor = { speed = -12, torque = 220 } }
end
at(11.5, function() for i = 1, 2 do find_joint("strut" .. i):set_motor_speed(0) end end)
expect { "it arrives", body = "car", x = {44, 85} }
expect { "it does not turn over", always = true, body = "car", angle = {-1, 1} }
expect { "wheels keep to their struts", always = true, joint = "strut*", joint_value = {-0.3, 0.3} }
expect { "nothing falls through the road", always = true, body = "*", y = {-1, 20} }
expect { "the seesaw has tipped over", body = "seesaw", angle = {-0.37, -0.1} }
