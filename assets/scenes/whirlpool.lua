-- whirlpool.lua - a pond seen from above that drains through a hole: all that swims in it goes round, the nearer the faster, and
-- is drawn in.
-- Shows: a vortex and a drain in a volume of water (swirl, outflow), pressure that holds on their circle those who go round.
scene { title = "Whirlpool", gravity = {0, 0}, duration = 30, seed = 5,
        description = "Logs, balls and a raft go round a hole in a pond: a vortex of Lamb and Oseen, and a drain." }
camera { fit = {{-8, -4.6}, {8, 4.6}}, at = 9, trail = 1.2 }

local SWIRL, DRAIN, CORE = 22, -3.2, 0.7
water { name = "pond", box { 24, 14 }, swirl = SWIRL, outflow = DRAIN, core_radius = CORE, category = "water" }
local wood = material { density = 600, friction = 0.3 }

-- Swimmers start with the water.
local function flow(x, y)
    local q = (1 - math.exp(-(x * x + y * y) / CORE ^ 2)) / (2 * math.pi * (x * x + y * y))
    return q * (DRAIN * x - SWIRL * y), q * (DRAIN * y + SWIRL * x)
end
local swimmers = {}
local function swim(name, x, y, shape, color)
    local vx, vy = flow(x, y)
    local b = body { name = name, shape, at = {x, y}, angle = random(0, 6), velocity = {vx, vy}, material = wood, color = color }
    swimmers[#swimmers + 1] = b
    return b
end
for i = 1, 14 do
    local r, a = 1.6 + 0.42 * i, 2.4 * i
    swim("log" .. i, r * math.cos(a), r * math.sin(a), box { 0.7, 0.14, round = 0.05 }, i % 2 == 0 and "#8d6e4a" or "#a9825a")
end
for i = 1, 10 do
    local r, a = 2 + 0.5 * i, 2.4 * i + 1
    swim("ball" .. i, r * math.cos(a), r * math.sin(a), circle { 0.16 }, i % 2 == 0 and "#c0392b" or "#e1b12c")
end
-- What is drawn into the hole is gone.
local gone = 0
every_step(function()
    for i = #swimmers, 1, -1 do
        local x, y = swimmers[i]:position()
        if x * x + y * y < 0.2 then
            swimmers[i]:destroy()
            table.remove(swimmers, i)
            gone = gone + 1
        end
    end
end)

-- Where it is after t from a distance r: r^2 + DRAIN t / pi, outside the core.
local probe = body { name = "probe", circle { 0.1 }, at = {6.5, 0}, velocity = {flow(6.5, 0)}, density = 1000, color = "#2d3436", collides = "water" }
expect { "what is as dense as water is drawn in as water is", at = 10, test = function()
    local x, y = probe:position()
    local r, theory = math.sqrt(x * x + y * y), math.sqrt(6.5 ^ 2 + DRAIN * 10 / math.pi)
    return math.abs(r - theory) < 0.03, r, theory
end }
expect { "and goes round as fast", at = 10, test = function()
    local x, y = probe:position()
    local vx, vy = probe:velocity()
    local r = math.sqrt(x * x + y * y)
    local round, theory = (x * vy - y * vx) / r, SWIRL / (2 * math.pi * r)
    return math.abs(round / theory - 1) < 0.01, round, theory
end }
expect { "the hole takes them, one by one", at = 30, test = function() return gone >= 5, gone, 5 end }
expect { "nobody is faster than the water at its fastest", always = true, test = function()
    local most = 0
    for _, b in ipairs(swimmers) do
        local vx, vy = b:velocity()
        most = math.max(most, math.sqrt(vx * vx + vy * vy))
    end
    return most < 1.3 * 0.6382 * SWIRL / (2 * math.pi * CORE), most, 1.3 * 0.6382 * SWIRL / (2 * math.pi * CORE)
end }
