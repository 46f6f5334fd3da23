-- friction_ramp.lua - Friction Ramp of Solver2D: boxes on a slope of tan 0.25 with friction 0 to 0.75, for 20 s.
-- Fails: stuck boxes creep (Solver2D tells of it), XPBD has no stiction. Right: above 0.25 they never move by a
-- millimetre; below they slide g (sin - mu cos) t^2 / 2.
scene { title = "Friction ramp", duration = 20, sleep = false }
local slope = math.atan(0.25)
local c, s = math.cos(slope), math.sin(slope)
body { type = "static", box { 10000, 2 }, at = {-s, -c}, angle = -slope, material = material { friction = 1 } }
for k, mu in ipairs { 0.75, 0.5, 0.3, 0.26, 0.2, 0.1, 0 } do
    -- mixed with 1 by the root of the product
    local m = material { friction = mu * mu }
    local start = -20 + 4 * k -- along the slope
    local crate = body { name = "box" .. k, box { 1, 1 }, angle = -slope, material = m,
                         at = {start * c + 0.5 * s, -start * s + 0.5 * c} }
    local function gone()
        local x, y = crate:position()
        return x * c - y * s - start
    end
    local since = 0
    at(1, function() since = gone() end)
    if mu > 0.25 then
        expect { ("at %g it stays"):format(mu), test = function()
            return math.abs(gone() - since) <= 1e-3, math.abs(gone() - since), 1e-3
        end }
    else
        local far = 9.81 * (s - mu * c) * 20 * 20 / 2
        expect { ("at %g it slides as Coulomb says"):format(mu), test = function()
            return math.abs(gone() / far - 1) <= 0.01, gone() / far, 1
        end }
    end
end
