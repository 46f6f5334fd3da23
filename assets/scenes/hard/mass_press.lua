-- mass_press.lua - the ram of a press, 10,000 times the mass, slides down a rail onto a 10 cm block that lies on a bed.
-- Fails: softness: the ram falls through the block (and in Box2D 10 m through the bed). Right: the block holds.
scene { title = "Press 10,000 : 1", duration = 4 }
local ratio = param("ratio", 10000, 1, 1e6)
body { type = "static", box { 40, 1 }, at = {0, -0.5} }
body { name = "block", box { 0.5, 0.1 }, at = {0, 0.05}, mass = 1 }
local ram = body { name = "ram", box { 1, 1 }, at = {0, 0.7}, mass = ratio }
prismatic { world, ram, axis = {0, 1} }
expect { "the ram rests on the block", from = 1, body = "ram", y = {0.59, 0.602} }
expect { "the ram never bounces up", always = true, body = "ram", y = {-1e6, 0.71} }
expect { "the block stays", always = true, body = "block", x = {-0.1, 0.1}, y = {0.04, 0.06} }
