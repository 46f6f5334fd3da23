-- compound.lua - tables and pointed ships of several shapes each. A plank that comes to lie on the legs' stretcher stays in the
-- table; a crate dropped on a table stands on it; a ship stands on its two fins, upright, and none of its shapes part.
scene { title = "Compound shapes", duration = 5 }
camera { fit = {{-10, -1}, {10, 8}}, at = 4 }
body { type = "static", box { 40, 1 }, at = {0, -0.5} }
local function table_at(name, x, color)
    return body { name = name, at = {x, 0}, color = color, box { 4, 0.4, at = {0, 2.2} }, box { 0.4, 2, at = {-1.8, 1} },
                  box { 0.4, 2, at = {1.8, 1} }, box { 3.2, 0.2, at = {0, 0.6} } }
end
table_at("table1", -6, 1)
table_at("table2", 0, 1)
body { name = "plank", box { 3, 0.2 }, at = {-6, 1.2}, color = 2 }
body { name = "crate", box { 1, 1 }, at = {0.5, 5}, color = 2 }
body { name = "ship", at = {7, 1}, color = 3, polygon { {-1.5, 0}, {0, 1}, {0, 4} }, polygon { {1.5, 0}, {0, 4}, {0, 1} } }
expect { "the plank lies within the table", body = "plank", x = -6, y = 0.8, tolerance = 0.02 }
expect { "the crate stands on the table", body = "crate", y = 2.9, angle = {-0.02, 0.02}, tolerance = 0.02 }
expect { "tables stand", from = 2, body = "table*", y = 0, angle = {-0.005, 0.005}, tolerance = 0.01 }
expect { "the ship stands on its fins", body = "ship", y = 0, angle = {-0.01, 0.01}, tolerance = 0.01 }
expect { "all lie still", from = 4, max_speed = 0.01 }
