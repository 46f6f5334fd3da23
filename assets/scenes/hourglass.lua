-- hourglass.lua - sand runs through a neck as fast at the end as at the beginning, and heaps up below.
-- Shows: liquid{} with friction: a granular phase. Water would run by the root of its depth.
scene { title = "Hourglass", duration = 6, description = "Sand runs from the upper glass into the lower one, evenly, and lies there in a heap." }
camera { fit = { {-1.3, -1.4}, {1.3, 1.5} }, at = 2 }
local friction = param("friction", 0.6, 0, 2)
local neck = 0.05
local glass = "#9fb8c8"

-- Left and right half of both bulbs, of two pieces each.
for side = -1, 1, 2 do
    local function wall(points)
        for i = 1, #points do points[i] = { side * points[i][1], points[i][2] } end
        body { type = "static", polygon(points), color = glass }
    end
    wall { { neck, 0.06 }, { neck, -0.06 }, { 1.1, -0.06 }, { 1.1, 0.06 } }
    wall { { neck, 0.06 }, { 1.1, 0.06 }, { 1.1, 0.9 }, { 0.92, 0.9 } }
    wall { { 0.92, 0.9 }, { 1.1, 0.9 }, { 1.1, 1.35 }, { 0.92, 1.35 } }
    wall { { neck, -0.06 }, { 0.92, -0.9 }, { 1.1, -0.9 }, { 1.1, -0.06 } }
    wall { { 0.92, -0.9 }, { 0.92, -1.25 }, { 1.1, -1.25 }, { 1.1, -0.9 } }
end
body { type = "static", name = "base", box { 2.4, 0.12, at = { 0, -1.31 } }, color = "#7a5a3a" }

liquid { spacing = 0.0125, density = 1600, friction = friction, color = "#e0b45c",
         polygon { { neck, 0.1 }, { 0.8, 0.8 }, { -0.8, 0.8 }, { -neck, 0.1 } } }

local function above() return (liquid_in(-1.2, 0, 1.2, 1.4)) end
local function below() return (liquid_in(-1.2, -1.3, 1.2, 0)) end
local all, early, late = 0, 0, 0
at(0, function() all = above() end)
local from
at(1, function() from = below() end)
at(1.5, function() early = below() - from end)
at(2.4, function() from = below() end)
at(2.9, function() late = below() - from end)

expect { "it runs on as it began", at = 3, test = function() return late > 0.9 * early and late < 1.2 * early, late, early end }
expect { "not a grain is lost", at = 6, test = function()
    local sum = above() + below()
    return math.abs(sum / all - 1) < 1e-6, sum, all
end }
expect { "it lies in a heap", at = 6, test = function()
    local _, middle = liquid_in(-0.1, -1.3, 0.1, 0)
    local _, side = liquid_in(0.75, -1.3, 0.85, 0)
    local slope = (middle - side) / 0.8
    return slope > 0.2 and slope < 0.85, slope, 0.85
end }
expect { "the heap rests", at = 6, test = function()
    local _, _, speed = liquid_in(-0.9, -1.25, 0.9, -0.95)
    return speed < 0.02, speed, 0.02
end }
