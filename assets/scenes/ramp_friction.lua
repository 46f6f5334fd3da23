-- ramp_friction.lua - boxes on an incline of 20 degrees with friction below and above tan(20 deg) = 0.364.
-- Shows: Coulomb's law. mu > tan(angle) sticks without creep; below, a box slides with
-- a = g (sin(angle) - mu cos(angle)), so that its path is s = a t^2 / 2: the closed form checked here.
scene { title = "Ramp with friction", duration = 1.5,
        description = "Boxes of different friction on one incline: some stick, some slide." }
camera { fit = {{-14, -5.5}, {10, 4.5}} }

local angle, g = math.pi / 9, 9.81
local rough = material { name = "ramp", friction = 1 }
local c, s = math.cos(angle), math.sin(angle)
body { name = "ramp", type = "static", box { 26, 0.5, at = {-2, -0.25} }, angle = angle, material = rough }

-- A pair's friction is the geometric mean: with mu_ramp = 1 a box of mu^2 gives mu.
local mus = { 0.0, 0.1, 0.2, 0.3, 0.45, 0.6 }
for i, mu in ipairs(mus) do
    local along = 8.5 - 2.0 * (i - 1) -- place along the ramp; the slippery ones are lowest, in nobody's way
    along = -along + 1.5
    local x, y = c * along - s * 0.25, s * along + c * 0.25
    local m = material { name = "mu" .. i, friction = mu * mu, density = 500 }
    local name = ("mu_%02d"):format(math.floor(100 * mu + 0.5))
    body { name = name, box { 0.5, 0.5 }, at = {x, y}, angle = angle, material = m, color = i,
           label = ("%.2f"):format(mu) }
    local a = math.max(0, g * (s - mu * c))
    exact {
        body = name,
        x = function(t) return x - c * a * t * t / 2 end,
        y = function(t) return y - s * a * t * t / 2 end,
    }
    local slide = a * 1.5^2 / 2
    expect {
        ("mu = %.2f %s"):format(mu, a > 0 and "slides by the law" or "sticks"), at = 1.5, body = name,
        position = { x - c * slide, y - s * slide }, tolerance = a > 0 and 0.015 or 0.001, -- sliding is first order: about a dt t / 2
    }
end
