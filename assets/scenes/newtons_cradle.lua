-- newtons_cradle.lua - the physics of Newton's cradle on a line: equal balls, e = 1, no friction.
-- Joints are not needed: a row of balls rests between two end walls; the outermost runs into the row, stops
-- dead, the ball at the other end leaves with its speed, meets its wall, returns. Small gaps keep the
-- blows one after the other, where theory is exact: equal masses exchange velocities.
-- The set of velocities is therefore always {v, 0, 0, 0, 0}: that is what the expectations say.
scene { title = "Newton's cradle on a line", gravity = {0, 0}, duration = 30,
        description = "Equal balls at e = 1 pass one speed through the row, wall to wall." }
camera { fit = {{-4.5, -1.6}, {4.5, 1.6}} }

local steel = material { name = "steel", density = 7800, friction = 0, restitution = 1 }
local r, gap, v = 0.3, 0.02, 3
body { name = "wall_left", type = "static", box { 0.4, 3 }, at = {-4.2, 0}, material = steel }
body { name = "wall_right", type = "static", box { 0.4, 3 }, at = {4.2, 0}, material = steel }
for i = 1, 5 do
    body {
        name = "ball" .. i, circle { r }, material = steel, color = i,
        at = {i == 1 and -3 or (i - 3) * (2 * r + gap), 0}, velocity = {i == 1 and v or 0, 0},
    }
end

-- What theory says of any moment: one ball has the whole speed, the others none.
local function exchange()
    local fastest, others = 0, 0
    for i = 1, 5 do
        local speed = find("ball" .. i):speed()
        others = math.max(others, math.min(speed, fastest))
        fastest = math.max(fastest, speed)
    end
    local off = math.max(math.abs(fastest - v), others) / v
    return off < 0.01, off, 0.01
end
expect { "the speed is exchanged, not shared", always = true, test = exchange }
expect { "energy is kept", always = true, energy_drift = 0.01 }
expect { "nothing leaves the line", always = true, body = "ball*", y = {-1e-3, 1e-3} }
