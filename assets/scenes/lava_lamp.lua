-- lava_lamp.lua - wax in a lamp: warm it is lighter than the water and rises, cold at the top it sinks again.
-- Shows: phases of liquid{}, each with density and viscosity in one system of pressures; liquid_change().
scene { title = "Lava lamp", duration = 30, description = "Wax that is warmed at the bottom rises as a plume, cools at the top and comes down." }
camera { fit = { {-1.5, -0.4}, {1.5, 4.4} }, at = 13 }
body { type = "static", name = "lamp", material = material { friction = 0.2 },
    polygon { {-1.2, -0.3}, {1.2, -0.3}, {1.2, 0}, {-1.2, 0} },
    polygon { {-1.2, 0}, {-0.9, 0}, {-0.6, 4}, {-0.9, 4} },
    polygon { {0.9, 0}, {1.2, 0}, {0.9, 4}, {0.6, 4} },
    polygon { {-0.9, 4}, {0.9, 4}, {0.9, 4.3}, {-0.9, 4.3} } }

liquid { spacing = param("spacing", 0.04, 0.02, 0.1), density = 1000, viscosity = 2, color = "#e8a0c0", phases = {
    { name = "warm wax", density = 950, viscosity = 20, color = "#ff7020" },
    { name = "cold wax", density = 1050, viscosity = 20, color = "#b02a3a" } } }
liquid { polygon { {-0.84, 0.8}, {0.84, 0.8}, {0.62, 3.9}, {-0.62, 3.9} } }
liquid { phase = "cold wax", polygon { {-0.9, 0}, {0.9, 0}, {0.84, 0.8}, {-0.84, 0.8} } }

every_step(function()
    liquid_change(-0.45, 0, 0.45, 0.25, "cold wax", "warm wax")
    liquid_change(-1, 3.5, 1, 4, "warm wax", "cold wax")
end)

local function wax() return liquid_in(-9, -9, 9, 9, "warm wax") + liquid_in(-9, -9, 9, 9, "cold wax") end
local all = wax()
local highest, sunk = 0, 0
every_step(function(t)
    local _, top = liquid_in(-9, -9, 9, 9, "warm wax")
    highest = math.max(highest, top or 0)
    sunk = math.max(sunk, (liquid_in(-9, 1, 9, 3, "cold wax")))
end)
expect { "it stays in the lamp", always = true, test = function() return liquid_in(-1, -0.01, 1, 4.01) == liquid_in(-9, -9, 9, 9) end }
expect { "no wax is lost", always = true, test = function() return math.abs(wax() - all) < 1e-6 end }
expect { "at first it lies below", at = 2, test = function() return liquid_in(-9, 1.5, 9, 9, "warm wax") == 0 end }
expect { "the warm rises to the top", at = 30, test = function() return highest > 3.2, highest, 3.2 end }
expect { "the cold comes down", at = 30, test = function() return sunk > 0.05, sunk, 0.05 end }
