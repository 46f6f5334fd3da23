-- oil_and_water.lua - oil is poured into water, goes under, comes up and floats; a cork lies on it, a plum between.
-- Shows: phases of liquid{}, refill as a source, bodies of any density in the one system of pressures.
scene { title = "Oil and water", duration = 16, description = "Oil that was poured in lies on the water; bodies come to rest by their densities." }
camera { fit = { {-1.7, -0.4}, {1.7, 2.9} }, at = 2.4 }
local glass = material { friction = 0.3 }
body { type = "static", name = "jar", material = glass, box { 3, 0.3, at = { 0, -0.15 } },
    box { 0.3, 3.5, at = { -1.35, 1.45 } }, box { 0.3, 3.5, at = { 1.35, 1.45 } } }

liquid { spacing = param("spacing", 0.03, 0.02, 0.1), color = "#3d86c6", phases = {
    { name = "oil", density = 700, viscosity = 0.5, color = "#e8b23a" } }, box { 2.4, 1.2, at = { 0, 0.6 } } }
every_step(function(t)
    if t < 3 then
        liquid { phase = "oil", box { 0.24, 0.12, at = { -0.6, 2.6 } }, velocity = { 0.3, -1.5 }, refill = true }
    end
end)
body { name = "cork", circle { 0.2 }, at = { 0.8, 2.3 }, density = 250, color = 5 }
body { name = "plum", circle { 0.2 }, at = { 0.2, 1.6 }, density = 850, color = 4 }

local function area(phase) return (liquid_in(-9, -9, 9, 9, phase)) end
local function mean(phase) return (select(5, liquid_in(-9, -9, 9, 9, phase))) end
expect { "nothing leaves the jar", always = true, test = function() return liquid_in(-1.21, -0.01, 1.21, 99) == area() end }
expect { "the oil comes up", at = 16, test = function() return mean("oil") - mean("water") > 0.6, mean("oil") - mean("water"), 0.6 end }
expect { "little of it is below the water's middle", at = 16, test = function()
    local below = liquid_in(-9, -9, 9, 0.6, "oil")
    return below < 0.02 * area("oil"), below, 0.02 * area("oil")
end }
expect { "the cork floats on the oil", at = 16, body = "cork", y = { 1.5, 2.1 } }
expect { "the plum floats between", at = 16, body = "plum", y = { 0.9, 1.5 } }
