-- tackle.lua - a winch lifts a crate by block and tackle, and drives a second wheel by a belt; a yo-yo, and Atwood's machine.
-- Shows: cables, ropes that run from wheel to wheel and wind on and off without slipping. Of n falls each bears 1 / n of the load
-- and moves n times as fast; a belt is a cable above and one beneath; a yo-yo of inertia I falls with g / (1 + I / (m r^2)), loads over
-- a wheel with (m1 - m2) g / (m1 + m2 + I / r^2).
scene { title = "Block and tackle", description = "A winch, four falls of rope, a belt, a yo-yo.", duration = 5 }
camera { fit = {{-1.6, -0.5}, {12.2, 7}}, at = 3 }
-- lint: allow mass-ratio: sheaves are light, as they should be

local g = 9.81
local stone = material { name = "stone", friction = 0.8 }
body { name = "ground", type = "static", box { 60, 1, at = {0, -0.5} }, material = stone }
body { name = "gantry", type = "static", color = "#d69e2e", box { 13, 0.3, at = {5.2, 6.6} }, box { 0.3, 6.6, at = {-1.2, 3.3} },
       box { 0.3, 6.6, at = {11.7, 3.3} }, apart = "all" }
local function disc(name, x, y, r, mass, color)
    return body { name = name, circle { r }, at = {x, y}, mass = mass, apart = "all", color = color }
end

-- Four falls over sheaves side by side: those below hang on the crate. Seen along the rope, it runs at the left of a rim of radius
-- r > 0, at the right of one of radius r < 0.
local r, sheave, load, top = 0.22, 4, 400, 5.7
local crate = body { name = "crate", box { 1.7, 1.1 }, box { 1.25, 0.3, at = {0, 0.7} }, at = {2 * r, 0.55}, mass = load, color = "#cf8a4f",
                     material = stone }
local function block(name, i, y, on)
    local wheel = disc(name, 2 * r * i, y, r, sheave, "#8fa3b8")
    revolute { on, wheel, hidden = true }
    return wheel
end
local low1, high1, low2, high2 = block("low 1", 0, 1.4, crate), block("high 1", 1, top, world), block("low 2", 2, 1.4, crate),
    block("high 2", 3, top, world)
local first = cable { world, low1, at_a = {-r, 6.45}, radius_b = -r, name = "first fall" }
cable { low1, high1, radius_a = -r, radius_b = r }
cable { high1, low2, radius_a = r, radius_b = -r }
cable { low2, high2, radius_a = -r, radius_b = r }

-- The winch: a drum with a motor, which winds the last fall; and a belt on its second rim.
local drum_radius, pace = 0.3, 4 -- [m], [rad/s]
local drum = disc("drum", 3.1, 1.1, 0.5, 40, "#5b8fbf")
local fan = disc("fan", 6.1, 1.4, 0.9, 20, "#74b083")
body { name = "stand", type = "static", color = "#4a5568", polygon {{2.8, 0}, {3.4, 0}, {3.1, 1.1}}, polygon {{5.7, 0}, {6.5, 0}, {6.1, 1.4}},
       apart = "all" }
revolute { world, drum, motor = { speed = pace, torque = 700 }, name = "winch" }
revolute { world, fan }
cable { high2, drum, radius_a = r, radius_b = -drum_radius, name = "hauled" }
cable { drum, fan, radius_a = 0.45, radius_b = 0.9, name = "belt above" }
cable { drum, fan, radius_a = -0.45, radius_b = -0.9, name = "belt beneath" }

-- A yo-yo, whose rope is wound on a thin axle.
local axle, yoyo_mass = 0.055, 2
local yoyo = disc("yo-yo", 8.4 - axle, 5.3, 0.4, yoyo_mass, "#c9605a")
cable { world, yoyo, at_a = {8.4, 6.45}, radius_b = axle, name = "string" }

-- Two loads over a heavy wheel.
local m1, m2, wheel_mass, wheel_radius = 4, 3, 20, 0.5
local wheel = disc("wheel", 10.3, 5.5, wheel_radius, wheel_mass, "#9b86bd")
revolute { world, wheel }
local heavy = body { name = "heavy", box { 0.55, 0.55 }, at = {9.8, 4}, mass = m1, color = "#74b083" }
local light = body { name = "light", box { 0.48, 0.48 }, at = {10.8, 0.8}, mass = m2, color = "#9b86bd" }
cable { wheel, heavy, radius_a = -wheel_radius, at_b = {9.8, 4.275}, name = "left" }
cable { wheel, light, radius_a = wheel_radius, at_b = {10.8, 1.04}, name = "right" }

local bears = (load + 2 * sheave) * g / 4
expect { "the first fall bears a quarter", at = 4.5, joint = "first fall", reaction = bears, tolerance = 0.01 * bears }
expect { "so does the one that the winch hauls", at = 4.5, joint = "hauled", reaction = bears, tolerance = 0.01 * bears }
expect { "the crate rises at a quarter of the rope's speed", at = 4.5, body = crate, vy = pace * drum_radius / 4, tolerance = 0.003 }
expect { "the belt turns the fan half as fast", at = 4.5, body = fan, spin = pace / 2, tolerance = 0.01 }
local a = g / (1 + 0.5 * 0.4^2 / axle^2)
expect { "the yo-yo falls slowly", at = 3, body = yoyo, vy = -3 * a, tolerance = 0.01 * a }
expect { "its string bears less than its weight", at = 3, joint = "string", reaction = yoyo_mass * (g - a), tolerance = 0.1 }
local b = (m1 - m2) * g / (m1 + m2 + wheel_mass / 2)
expect { "the loads move as Atwood says", at = 2, body = heavy, vy = -2 * b, tolerance = 0.01 }
expect { "the wheel turns with them", at = 2, body = wheel, spin = 2 * b / wheel_radius, tolerance = 0.02 }
expect { "the left rope bears more", at = 2, joint = "left", reaction = m1 * (g - b), tolerance = 1.5 }
expect { "than the right", at = 2, joint = "right", reaction = m2 * (g + b), tolerance = 1.5 }
