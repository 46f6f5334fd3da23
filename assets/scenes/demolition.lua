-- demolition.lua - a ball on a chain goes through a house of panels and floors: what is struck hard breaks where it is struck, what
-- falls breaks as it lands, and the parts pile up. Cracks are dense where the blow was.
scene { title = "Demolition", duration = 9, seed = 1, substeps = 8, description = "A house that breaks where it is struck." }
local concrete = material { name = "concrete", density = 24, friction = 0.6, restitution = 0.05 }
local iron = material { name = "iron", density = 160, friction = 0.4 }
body { name = "ground", type = "static", box { 50, 2 }, at = {6, -1}, color = "#5b4a3a" }
local panels = 0
local function panel(x, y, w, h, color)
    panels = panels + 1
    body { name = "panel" .. panels, box { w, h }, at = {x, y}, material = concrete, color = color,
           break_impulse = 70, break_energy = 120, break_cells = 16 }
end
for floor = 0, 3 do
    local y = floor * 2.4
    for side = -1, 1 do panel(6 + 2.8 * side, y + 1, 0.5, 2, "#a0aec0") end
    panel(6, y + 2.2, 7, 0.4, "#718096")
end
body { name = "crane", type = "static", box { 0.4, 0.4 }, at = {-1, 14}, collides = {}, color = "#4a5568" }
local ball = body { name = "ball", circle { 1.1 }, at = {-10, 9.2}, material = iron, color = "#2d3748", continuous = true }
distance { "crane", "ball", at_a = {-1, 14}, at_b = {-10, 9.2}, limits = {0, 10.3} }
local broke, energy = 0, 0
on_shatter { function(_, e)
    broke, energy = broke + 1, energy + e.energy
    score("broken", broke)
end }
score("broken", 0)
camera { fit = {{-6, -1.2}, {16, 13}}, at = 2.5 }
expect { "it breaks", at = 9, test = function() return broke >= 6, broke, 6 end }
expect { "for no less than it takes to", at = 9, test = function() return energy >= 50 * broke, energy, 50 * broke end }
expect { "the heap rests", at = 9, max_penetration = 0.03 }
