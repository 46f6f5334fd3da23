-- motor_through_limit.lua - motors of 10 to 1e6 N m drive an arm of 1 kg m^2 against a stop.
-- Fails: motor and limit as two rows that fight: 2.6 rad through, here and in Box2D. Right: a stop is a stop, whatever
-- the motor can do.
scene { title = "Motor through a limit", gravity = {0, 0}, duration = 3 }
for k = 1, 6 do
    local arm = body { name = "arm" .. k, box { 2, 0.2 }, at = {3 * k, 0}, mass = 3 }
    revolute { arm, at = {3 * k, 0}, limits = {-0.5, 0.5}, motor = { speed = 10, torque = math.pow(10, k) }, name = "stop" .. k }
end
for k = 1, 6 do
    expect { ("%g N m: stopped within a degree"):format(math.pow(10, k)), from = 0.1, joint = "stop" .. k,
             joint_value = {-0.01, 0.5175} }
end
expect { "no hinge comes apart by 1 cm", always = true, max_joint_error = 0.01 }
