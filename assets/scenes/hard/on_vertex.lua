-- on_vertex.lua - boxes on a corner: in a groove, where they stay, and on the flat, where they are in balance exactly.
-- Fails: a corner contact that hops between two edges. Right: in the groove it lies still for ever; on the flat it
-- stays while nothing disturbs it, and does not spin up by itself.
scene { title = "On a vertex", duration = 6, sleep = false }
local stone = material { friction = 0.6 }
body { type = "static", material = stone, box { 8, 1, at = {6, -0.5} },
       polygon {{-4, -1}, {-2, -1}, {-4, 1}}, polygon {{-2, -1}, {0, -1}, {0, 1}} }
local r = math.sqrt(0.5)
body { name = "in_groove", box { 1, 1 }, at = {-2, -1 + r}, angle_deg = 45, material = stone }
body { name = "flat", box { 1, 1 }, at = {5, r}, angle_deg = 45, material = stone }
body { name = "triangle", regular(3, 0.5), at = {8, 0.5}, angle_deg = 180, material = stone }
expect { "the groove holds", always = true, body = "in_groove", position = {-2, -1 + r}, tolerance = 0.005 }
expect { "it does not turn", body = "in_groove", angle = math.pi / 4, tolerance = 0.005 }
expect { "the square stands or falls whole", always = true, body = "flat", y = {0.495, r + 1e-3}, x = {3.8, 6.2} }
expect { "the triangle stands or falls whole", always = true, body = "triangle", y = {0.24, 0.501}, x = {7, 9} }
