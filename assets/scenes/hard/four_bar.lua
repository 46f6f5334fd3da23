-- four_bar.lua - a ladder of parallelograms through its singular pose: four bars and a fifth that says the same again,
-- turned by a motor through the place where all lie on one line.
-- Fails: direct solvers that cannot do with redundant rows, soft ones that bend over. Right: bars stay parallel.
scene { title = "Parallelogram with a bar too many", gravity = {0, 0}, duration = 6 }
local bars, rate = param("bars", 5, 2, 40), param("rate", 2, 0.1, 20)
local beam = body { name = "beam", box { bars - 1, 0.1 }, at = {(bars - 1) / 2, 1}, mass = 2, apart = "linkage" }
for i = 1, bars do
    local bar = body { name = "bar" .. i, box { 0.08, 1 }, at = {i - 1, 0.5}, mass = 1, apart = "linkage" }
    local hinge = revolute { bar, at = {i - 1, 0} }
    if i == 1 then hinge:set_motor(rate, 1e4) end
    revolute { bar, beam, at = {i - 1, 1} }
end
expect { "the beam stays level", always = true, body = "beam", angle = {-0.02, 0.02} }
expect { "no pin opens by 1 cm", always = true, max_joint_error = 0.01 }
expect { "it turned as the motor says", test = function()
    local x, y = beam:position()
    local angle = rate * 6 + math.pi / 2
    local dx, dy = x - (bars - 1) / 2 - math.cos(angle), y - math.sin(angle)
    local off = math.sqrt(dx * dx + dy * dy)
    return off <= 0.1, off, 0.1
end }
