-- conveyor.lua - three belts carry crates and drop them from one to the next, into a bin.
-- Shows: surfaces that run (surface_speed), rolling resistance, a sensor that counts.
-- A crate put down on a belt is drawn along by friction: it has the belt's speed v after v / (mu g) seconds.
scene { title = "Conveyor", description = "Running surfaces carry what lies on them.", duration = 30, seed = 4 }
camera { fit = {{-8, -3.2}, {8, 6}}, at = 13 }

local v, mu = 1.5, 0.6
local right = material { name = "belt right", friction = mu, surface_speed = v }
local left = material { name = "belt left", friction = mu, surface_speed = -v }
local board = material { name = "board", density = 20, friction = mu }
local steel = material { name = "steel", friction = 0.4 }

local function belt(name, x, y, length, stuff)
    body { name = name, type = "static", capsule { length, 0.25 }, at = {x, y}, material = stuff, color = "#718096" }
end
belt("upper", -2, 4, 8, right)
belt("middle", 2, 2, 8, left)
belt("lower", -2, 0, 8, right)
body { name = "chutes", type = "static", material = steel, color = "#a0aec0",
       box { 0.2, 3, at = {6.8, 3} }, box { 0.2, 3, at = {-6.8, 1} },
       box { 6.2, 0.2, at = {4.4, -3} }, box { 0.2, 2.4, at = {1.4, -1.8} }, box { 0.2, 4, at = {7.4, -1.1} } }
-- The bin counts what falls in; a box that is a sensor stops nothing.
local bin = body { name = "bin", type = "static", sensor = true, box { 5.7, 2, at = {4.4, -1.8} }, color = "#74b083" }

local count = 8
for i = 1, count do
    at(1.3 * (i - 1), function()
        local size = random(0.45, 0.65)
        body { name = "crate" .. i, box { size, size }, at = {-5.5, 4.25 + size / 2 + 0.005}, material = board, color = i }
    end)
end
on_enter { a = bin, function(_, crate) score("in the bin", score("in the bin") + 1) end }

-- The first crate at rest: speed v after v / (mu g) = 0.25 s, no sooner.
local reached
every_step(function(t)
    local crate = find("crate1")
    if not reached and crate and crate:speed() > 0.99 * v then reached = t end
end)
expect { "friction brings a crate to speed in v / (mu g)", at = 1, test = function()
    local theory = v / (mu * 9.81)
    local off = math.abs((reached or 0) - theory)
    return off < 0.03, reached or 0, theory
end }
expect { "it goes on at the belt's speed", at = 2, body = "crate1*", vx = v, tolerance = 0.02 }
expect { "every crate is counted", body = "bin", visits = count }
expect { "every crate is in the bin", body = "bin", inside = count }
expect { "they lie still there", body = "crate*", max_speed = 0.05 }
