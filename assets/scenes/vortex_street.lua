-- vortex_street.lua - wind past a post: vortices leave it by turns, left and right, and push it from side to side.
-- Shows: a wind tunnel of air{} with a flow, viscosity, smoke that shows it, a body that feels the vortices on a spring.
scene { title = "Vortex street", dt = 1 / 30, duration = 22, gravity = {0, 0},
        description = "Re = 150: the vortices leave a post of 1 m at 0.2 times 1 m/s over 1 m." }
camera { fit = {{-3.4, -3.4}, {12.6, 3.4}}, at = 22 }
local speed, reynolds = 1, param("reynolds", 150, 60, 300)
air { size = {16, 8}, at = {4.6, 0}, cell = param("cell", 0.16, 0.05, 0.25), viscosity = speed / reynolds,
      left = "flow", top = "flow", bottom = "flow", flow = {speed, 0}, fading = 0.02 }
local post = body { name = "post", circle { 0.5 }, at = {0, 0.02}, density = 12, fixed_rotation = true, color = 1 }
body { type = "static", name = "frame", sensor = true, box { 0.1, 0.1, at = {0, 0} }, hidden = true }
prismatic { "frame", "post", at = {0, 0}, axis = {0, 1}, spring = { frequency = 0.6, damping = 0.05 } }
for _, y in ipairs { -0.55, 0.55 } do air_source { at = {-2.2, y * 0.9}, radius = 0.3, smoke = 3.2 } end

local crossings, last, first_at, last_at = 0, 0, nil, nil
every_step(function(t)
    local _, y = post:position()
    local _, v = air_at(3, 0)
    if t > 10 and last < 0 and v >= 0 then
        crossings, first_at, last_at = crossings + 1, first_at or t, t
    end
    last = v
end)

expect { "vortices leave at the Strouhal number", at = 22, test = function()
    local strouhal = crossings > 1 and (crossings - 1) / (last_at - first_at) or 0
    return strouhal > 0.15 and strouhal < 0.24, strouhal, 0.2
end }
