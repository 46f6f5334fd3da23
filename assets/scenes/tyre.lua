-- tyre.lua - two carts go over the same rough road: the upper one on tyres of gas with spokes that only pull, the lower one on
-- rigid wheels of the same size. Shows: softbody{} as a ring with gas in it, held to a hub by pins; a motor that drives through
-- the spokes. What stands on a tyre is carried by its pressure times the patch that lies on the road.
scene { title = "Tyres of gas, and rigid wheels", duration = 9,
        description = "The same cart, road and motor: gas swallows what a rigid wheel climbs." }
camera { fit = {{-1.4, -3.0}, {4, 1.8}}, at = 5.45 }
local g, R, pressure, load, speed, lower = 9.81, 0.45, 1500, 100, 2, -2.6
local rubber = material { name = "rubber", friction = 1 }

-- Both lanes: even where the carts stand at first, then stones, then even again.
local stones = {{-6, 0}, {-1.5, 0}}
for i = 0, 9 do
    local x, h = -1.2 + 0.7 * i, 0.03 + 0.03 * (i * 7 % 3) / 2
    for _, p in ipairs { {x, 0}, {x + 0.08, h}, {x + 0.2, h}, {x + 0.28, 0} } do stones[#stones + 1] = p end
end
stones[#stones + 1] = {14, 0}
for i, y in ipairs { 0, lower } do
    body { name = "road" .. i, type = "static", material = rubber, at = {0, y}, chain(stones) }
end

local function cart(name, y, color)
    local frame = body { name = name, at = {-3.2, y + R}, mass = load, damping = 6, color = color, collides = {}, box { 2.5, 0.14, at = {0, 0.58} },
                         box { 0.14, 0.6, at = {-0.8, 0.26} }, box { 0.14, 0.6, at = {0.8, 0.26} },
                         polygon {{0.25, 0.65}, {1.2, 0.65}, {1.2, 0.85}, {0.8, 1.2}, {0.25, 1.2}} }
    local drive = {}
    for side = -1, 1, 2 do
        local x, soft = -3.2 + 0.8 * side, y == 0
        local hub = body { name = name .. (side < 0 and ".rear" or ".front"), at = {x, y + R}, circle { soft and 0.12 or R }, mass = soft and 6 or 10,
                           material = rubber, label = " ", collides = soft and {} or nil, color = soft and "#4a5568" or "#8b93a1" }
        drive[#drive + 1] = revolute { frame, hub, at = {x, y + R}, motor = { speed = 0, torque = 150 } }
    end
    return frame, drive
end
local soft, soft_drive = cart("on gas", 0, "#3f8f6b")
local rigid, rigid_drive = cart("on rigid wheels", lower, "#c0504a")

-- A tyre: a skin of nodes, and a spoke to each, which leans one way or the other, so that the hub can turn it.
local n, tyres, skin = 50, {}, 4e4 -- [N] of a strain of 1
for side = -1, 1, 2 do
    local nodes, edges, pins, ring, x = {}, {}, {}, {}, -3.2 + 0.8 * side
    local chord, grip = 2 * (R - 0.02) * math.sin(math.pi / n), 0.1
    local spoke = 1.02 * math.sqrt((R - 0.02)^2 + grip^2 - 2 * (R - 0.02) * grip * math.cos(1.2)) -- slack: the skin holds the gas
    for k = 1, n do
        local a, lean = 2 * math.pi * (k - 1) / n, (k % 2 == 0 and 1 or -1) * 1.2
        nodes[k] = { x + (R - 0.02) * math.cos(a), R + (R - 0.02) * math.sin(a), 0, 0, 4 / n, 0.02 }
        nodes[n + k] = { x + grip * math.cos(a + lean), R + grip * math.sin(a + lean), 0, 0, 1e-3, 0 }
        pins[k] = { n + k, grip * math.cos(a + lean), grip * math.sin(a + lean), "on gas" .. (side < 0 and ".rear" or ".front") }
        edges[2 * k - 1] = { k, k % n + 1, chord, skin / chord, 40, 0, 0, 0 }
        edges[2 * k] = { k, n + k, spoke, 2e4, 20, 0, 0, 1 }
        ring[k] = {k}
    end
    tyres[#tyres + 1] = softbody { nodes = nodes, edges = edges, pins = pins, ring = ring, pressure = pressure, ambient = 4e3, friction = 1,
                                   drag = 0.1, color = "#2f3640" }
end

-- What lies on the road carries pressure times its length, less what the skin pulls up with at the two ends of it.
local function carried(t)
    local m, sum = t:measure(), 0
    for k = 1, n do
        local x, y = t:node(k)
        local x2, y2 = t:node(k % n + 1)
        local chord = math.sqrt((x2 - x) ^ 2 + (y2 - y) ^ 2)
        local pull = skin * (chord / (2 * (R - 0.02) * math.sin(math.pi / n)) - 1)
        if (y > 0.021) ~= (y2 > 0.021) then
            local down = y > y2 and 1 or -1 -- where the patch begins
            sum = sum - down * m.pressure * (x + x2) / 2 - pull * math.abs(y2 - y) / chord
        end
    end
    return sum
end
local weight = g * (load + 2 * 6 + 2 * 4)

-- Damping ends the first bounces; under way there is none.
at(3, function()
    for _, drive in ipairs { soft_drive[1], soft_drive[2], rigid_drive[1], rigid_drive[2] } do drive:set_motor_speed(-speed / R) end
    for _, frame in ipairs { soft, rigid } do frame:set_damping(0) end
end)
local hubs, last, shaken = { find("on gas.front"), find("on rigid wheels.front") }, {}, {0, 0}
every_step(function(t)
    for i = 1, 2 do
        local _, v = hubs[i]:velocity()
        if t > 4 and t < 7 then shaken[i] = shaken[i] + ((v - last[i]) * 60) ^ 2 / 180 end
        last[i] = v
    end
end)

expect { "gas carries the cart by pressure times the patch", at = 2.9, test = function()
    local sum = carried(tyres[1]) + carried(tyres[2])
    return math.abs(sum / weight - 1) < 0.06, sum, weight
end }
expect { "its hub is shaken less than half as much", at = 9, test = function()
    local share = math.sqrt(shaken[1] / shaken[2])
    return share < 0.5, share, 0.5
end }
expect { "its hub does not fall through to the road", always = true, body = "on gas.*", y = {0.2, 0.6} }
-- A tyre rolls on a radius between the height of its hub and that of the skin.
expect { "the cart on gas arrives", body = "on gas", x = {-3.2 + 0.8 * speed * 6 - 0.5, -3.2 + speed * 6} }
expect { "so does the other", body = "on rigid wheels", x = {-3.2 + 0.8 * speed * 6, -3.2 + speed * 6} }
expect { "joints hold", always = true, max_joint_error = 0.01 }
