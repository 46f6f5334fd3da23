-- honey.lua - honey runs from a spout onto bread, heaps up, and creeps over the edges.
-- Shows: liquid{} of 60 Pa s by one implicit system of stresses, refill as a source.
scene { title = "Honey", duration = 8, description = "Honey heaps up under the spout, spreads slowly and runs down the sides." }
camera { fit = { {-1.5, -0.3}, {1.5, 1.5} }, at = 6 }
local wood = material { density = 700, friction = 0.6 }
body { type = "static", name = "table", box { 6, 0.2, at = { 0, -0.1 } }, material = wood }
body { type = "static", name = "bread", box { 1.2, 0.3, at = { 0, 0.15 } }, material = wood, color = 3 }

liquid { spacing = 0.02, density = 1400, viscosity = param("viscosity", 60, 1, 1000), color = "#d08a10" }

every_step(function(t)
    if t < 4 then
        liquid { box { 0.12, 0.08, at = { 0, 1.3 } }, velocity = { 0, -0.6 }, refill = true }
    end
end)

local function area() return (liquid_in(-9, -9, 9, 9)) end
local heap = 0
at(4, function() heap = select(2, liquid_in(0.1, 0.3, 0.3, 0.8)) - 0.3 end)

expect { "it heaps up under the spout", at = 4, test = function()
    local _, top = liquid_in(0.1, 0.3, 0.3, 0.8)
    return top - 0.3 > 0.1, top - 0.3, 0.1
end }
expect { "then it spreads", at = 8, test = function()
    local _, top = liquid_in(0.1, 0.3, 0.3, 0.8)
    return top - 0.3 < 0.8 * heap, top - 0.3, 0.8 * heap
end }
expect { "it creeps", at = 8, test = function()
    local _, _, speed = liquid_in(-9, -9, 9, 9)
    return speed < 0.3, speed, 0.3
end }
expect { "what came is there", at = 8, test = function() return area() > 0.2, area(), 0.2 end }
