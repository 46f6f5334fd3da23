-- rocket.lua - a rocket goes into orbit about a small planet with air: thrust that burns fuel, drag, an attractor. It rises, tips over,
-- coasts with its engine off until it is at the top of its way, and burns again until it is as fast as a circle asks. The
-- probe in empty space is for the rocket equation: v = u ln(m0 / m1).
scene { title = "Rocket to orbit", gravity = {0, 0}, duration = 60, description = "Thrust, fuel, drag, and a planet's pull." }
local GM, ground, top = 16000, 40, 58
body { name = "planet", type = "static", circle { ground }, color = "#5b7f4e" }
attractor { body = "planet", strength = GM, only = "ship" }
local rocket = body { name = "rocket", polygon { {2, 0}, {-1.2, 0.7}, {-1.2, -0.7}, category = "ship" }, at = {0, ground + 1.25},
                      angle = math.pi / 2, mass = 10, fuel = 8, thrust = 140, exhaust = 40, thrust_x = -1.2, color = 2 }
local probe = body { name = "probe", circle { 1 }, at = {-100, -67}, mass = 4, fuel = 2, thrust = 1, exhaust = 30, color = 5 }

local state = "climb"
local function guide(rx, ry, vx, vy)
    local r, v2 = math.sqrt(rx * rx + ry * ry), vx * vx + vy * vy
    local momentum, energy = rx * vy - ry * vx, v2 / 2 - GM / r
    local e = math.sqrt(math.max(0, 1 + 2 * energy * momentum * momentum / (GM * GM)))
    local farthest = energy < 0 and momentum * momentum / (GM * math.max(1e-9, 1 - e)) or 1e9
    if state == "climb" and farthest >= top then state = "coast" end
    if state == "coast" and (rx * vx + ry * vy) / r < 0.5 then state = "round" end
    if state == "round" and v2 >= GM / r then state = "orbit" end
    -- Ahead is to the right, clockwise; it tips over from upwards within 8 m.
    local up, tip = math.atan(ry, rx), math.min(1, (r - ground) / 8)
    return r, state == "climb" and up - tip * 1.1 or up - math.pi / 2
end
every_step(function()
    local rx, ry = rocket:position()
    local vx, vy = rocket:velocity()
    local r, heading = guide(rx, ry, vx, vy)
    rocket:set_thrust((state == "climb" or state == "round") and 140 or 0)
    rocket:set_drag(r < ground + 16 and 0.03 * math.exp((ground - r) / 4) or 0)
    if r > ground + 2 then
        local off = heading - rocket:angle()
        rocket:set_spin(12 * math.atan(math.sin(off), math.cos(off)))
    end
end)
camera { fit = {{-70, -70}, {70, 70}}, at = 45, trail = 60 }
local circle = math.sqrt(GM / top)
expect { "it flies on a circle", body = "rocket", at = 60, min_speed = 0.95 * circle, max_speed = 1.05 * circle }
local fast = 30 * math.log(4 / 3)
expect { "the rocket equation", body = "probe", at = 30, min_speed = fast * (1 - 1e-5), max_speed = fast * (1 + 1e-5) }
