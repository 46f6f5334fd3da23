-- A laser in a maze of mirrors. A ball falls through two of its lanes into the cup of a lever, and the mirror on the lever sends the beam
-- up into a prism, which turns it by total reflection towards the target: five mirrors and two faces of glass on the way.
scene { title = "Mirror maze", duration = 6 }

local KEEPS = 0.98 -- share of a mirror
local wood = material { density = 100, friction = 0.6 }
local dark = material { friction = 0.6 }
local mirror = material { reflectance = KEEPS }
local glass = material { refractive_index = 1.5 }
local stone = material { density = 120, friction = 0.9 }

-- walls, and lanes between them
body { name = "frame", type = "static", material = dark,
    box { 12.8, 0.3, at = {6, 8.15} }, box { 12.8, 0.3, at = {6, 0.85} },
    box { 0.3, 7.6, at = {-0.25, 4.5} }, box { 0.3, 7.6, at = {12.25, 4.5} } }
body { name = "walls", type = "static", material = dark,
    box { 7.2, 0.16, at = {3.5, 6} }, box { 1.4, 0.16, at = {9.2, 6} },
    box { 4.6, 0.16, at = {3.1, 5} }, box { 1.4, 0.16, at = {9.2, 5} },
    box { 2.6, 0.16, at = {3.9, 3.5} }, box { 2.6, 0.16, at = {10.1, 3.5} },
    box { 0.16, 1.6, at = {9, 2} } }

-- mirrors stand at their lanes' ends, `side` is that of the diagonal
local function corner(name, x, y, side)
    body { name = name, type = "static", at = {x, y}, segment { {-0.4, -0.4 * side}, {0.4, 0.4 * side} }, material = mirror }
end
corner("first", 11.2, 6.9, -1)  -- to the right, then down
corner("second", 11.2, 4.3, 1)  -- then to the left
corner("third", 1.2, 4.3, 1)    -- down
corner("fourth", 1.2, 2.5, -1)  -- to the right again

-- the lever, held up by a weak motor, slow by a dashpot; the mirror stands in its pivot
body { name = "lever", at = {6, 2.5}, angle_deg = 15, material = wood,
    segment { {-0.3, -0.3 * math.tan(radians(60))}, {0.3, 0.3 * math.tan(radians(60))}, material = mirror },
    box { 2.1, 0.08, at = {1.3, 0}, density = 20 },
    box { 0.08, 0.5, at = {1.55, 0.21}, density = 20 },
    box { 0.08, 0.5, at = {2.31, 0.21}, density = 20 } }
revolute { "lever", world, at = {6, 2.5}, limits = {0, radians(30)}, motor = { speed = -2, torque = 110 }, spring = { damper = 60 }, name = "pivot" }

body { name = "gate", type = "static", box { 0.8, 0.1 }, at = {7.93, 7.35}, material = dark }
body { name = "ball", circle { 0.2 }, at = {7.93, 7.61}, material = stone }
at(1.5, function() find("gate"):destroy() end)

body { name = "prism", type = "static", at = {6, 5.5}, material = glass,
    polygon { {-0.42, -0.42}, {0.42, -0.42}, {0.42, 0.42} } }
body { name = "target", type = "static", box { 0.2, 0.7 }, at = {11.9, 5.5}, color = "#3aa655" }

light { name = "laser", at = {0.1, 6.9}, power = 1, color = "#e5302a", least = 0.002 }

-- What five mirrors and two faces of glass at a right angle leave, and it comes through the prism by total reflection.
local LEFT = KEEPS * KEEPS * KEEPS * KEEPS * KEEPS * 0.96 * 0.96
expect { "the target is dark at first", at = 1, test = function()
    local kept = light_on("target")
    return kept < 1e-6, kept, 1e-6
end }
expect { "the beam goes round four mirrors", from = 0, till = 1.4, test = function()
    local path = light_path("laser")
    return path[5].body == "lever" and path[6].body == "walls", #path, 6
end }
expect { "the ball falls through the first lane", at = 1.88, test = function()
    local path = light_path("laser")
    return path[1].body == "ball", path[1].x1, 7.93
end }
expect { "the ball lies in the cup", at = 5.5, body = "ball", x = {7.5, 8.4}, y = {1.8, 2.8} }
expect { "the beam reaches the target", from = 4, test = function()
    local kept = light_on("target", "laser")
    return math.abs(kept - LEFT) < 2e-3, kept, LEFT
end }
expect { "its way is the one of the images", at = 6, test = function()
    local length = 0
    for i, p in ipairs(light_path("laser")) do
        if i <= 9 then
            length = length + math.sqrt((p.x1 - p.x0)^2 + (p.y1 - p.y0)^2)
        end
    end
    -- 11.1 right, 2.6 down, 10 left, 1.8 down, 4.8 right, 3 up, 5.8 right
    return math.abs(length - 39.1) < 0.02, length, 39.1
end }
camera { fit = {{-0.4, 0.7}, {12.4, 8.3}}, at = 5 }
