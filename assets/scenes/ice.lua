-- ice.lua - a sheet of ice bears a load until that is too heavy: it breaks by force about where the load lies, and the floes float on
-- the water with what fell in. Parts have no bounds of their own, so they do not break again.
scene { title = "Thin ice", duration = 14, description = "Ice that breaks under a load and floats." }
local ice = material { name = "ice", density = 917, friction = 0.1, restitution = 0 }
local wood = material { name = "wood", density = 480, friction = 0.5 }
water { name = "lake", box { 16, 5 }, at = {0, -2.5}, color = "#3a7ca5" }
for side = -1, 1, 2 do
    local x = { 7, 7, 8, 12, 12, 7.4, 7.4 }
    for i = 1, 7 do x[i] = side * x[i] end
    body { type = "static", outline { {x[1], 0}, {x[2], -0.4}, {x[3], -5}, {x[4], -5}, {x[5], 1}, {x[6], 1}, {x[7], 0} },
           color = "#5b4a3a", name = "bank" .. (side < 0 and "_left" or "_right") }
end
body { type = "static", box { 24, 1 }, at = {0, -5.5}, color = "#5b4a3a", name = "bottom" }
local sheet = body { name = "sheet", box { 14.4, 0.15 }, at = {0, 0.075}, material = ice, color = "#cfe8f3", break_force = 21500, break_cells = 22 }
local broke, force
on_shatter { a = "sheet", function(_, e) broke, force = time(), e.impulse * 60 end }
local crates = 0
every(1.2, function()
    if broke or crates == 7 then return end
    crates = crates + 1
    body { name = "crate" .. crates, box { 0.9, 0.9 }, at = {0.1 * (crates % 2), 0.62 + 0.9 * (crates - 1)}, material = wood, color = "#b7791f" }
end)
camera { fit = {{-8.5, -5}, {8.5, 5}}, at = 9 }
expect { "it bears some crates first", at = 14, test = function() return crates >= 2, crates, 2 end }
expect { "it breaks", at = 14, test = function() return broke ~= nil and force > 21500, force or 0, 21500 end }
expect { "floes float as deep as ice is dense, the crates with them", at = 14, test = function()
    local low = 0
    for i = 1, crates do
        local _, y = find("crate" .. i):position()
        low = math.min(low, y)
    end
    return low > -1, low, -1
end }
expect { "it comes to rest", at = 14, max_speed = 0.6 }
