-- shooting_range.lua - bullets through panes of glass, and one that a thick one stops: bodies that shatter by the impulse of a blow.
-- A pane bears what its energy takes and no more, so the bullet flies on, slower; the parts have the momentum that it lost.
scene { title = "Shooting range", duration = 4, seed = 3, description = "Panes that break by the blow, and what it costs the bullet." }
local glass = material { name = "glass", density = 12, friction = 0.4, restitution = 0.1 }
local lead = material { name = "lead", density = 110, friction = 0.3 }
body { name = "floor", type = "static", box { 40, 1 }, at = {6, -0.5}, color = "#4a5568" }
body { name = "stop", type = "static", box { 1, 6 }, at = {17, 3}, color = "#4a5568" }
for i = 1, 5 do
    body { name = "pane" .. i, box { 0.36, 2.4 }, at = {2.6 * i - 1, 1.2}, material = glass, color = "#9bd1e5",
           break_impulse = 1.5, break_energy = 60, break_cells = 14 + 4 * i }
end
body { name = "block", box { 1.2, 1.4 }, at = {15, 0.7}, material = glass, break_impulse = 400, color = "#718096" }
local bullets, shots, lost, told = {}, 0, 0, 0
local function shoot(height, speed)
    shots = shots + 1
    bullets[shots] = body { name = "bullet" .. shots, circle { 0.1 }, at = {-3, height}, velocity = {speed, 0}, continuous = true,
                            material = lead, color = "#d69e2e" }
end
for i = 0, 2 do at(0.2 + 0.5 * i, function() shoot(1.5 - 0.25 * i, 60) end) end
local first
on_shatter { a = "pane*", function(pane, e)
    told = told + 1
    lost = lost + e.energy
    first = first or { other = e.other:name(), energy = e.energy }
    score("broken", told)
end }
score("broken", 0)
local sx, sy
camera { fit = {{-1.5, -0.8}, {12.5, 5}}, at = 0.42, trail = 0.05 }
expect { "all panes broke", at = 2, test = function() return told == 5, told, 5 end }
expect { "by a bullet, for at least the energy that glass takes", at = 2, test = function()
    return first.other == "bullet1" and first.energy >= 60 - 1e-3, first.energy, 60
end }
expect { "the block holds", at = 4, test = function() return find("block.1") == nil and find("block") ~= nil, body_count(), 0 end }
expect { "nothing lies in anything else", at = 4, max_penetration = 0.03 }
