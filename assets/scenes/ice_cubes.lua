-- ice_cubes.lua - ice on a hot plate melts into a pool, in which what is left of it floats. Shows: heat through contacts, latent
-- heat, bodies that become liquid; their mass is in the pool.
scene { title = "Ice cubes", duration = 24, description = "A hot plate melts ice into water, and the rest floats in it." }
camera { fit = { {-1.5, -0.35}, {1.5, 1.75} }, at = 9 }
liquid { spacing = 0.03, color = "#3d86c6", box { 2.4, 0.12, at = { 0, 0.06 } } }
body { type = "static", name = "plate", color = "#8a4b3a", box { 3, 0.3, at = { 0, -0.15 } }, temperature = 900, conductance = 1e6 }
body { type = "static", name = "jar", color = "#9aa4ad", box { 0.3, 2, at = { -1.35, 1 } }, box { 0.3, 2, at = { 1.35, 1 } } }

local first, cubes = 0, {}
for i = 1, 6 do
    local size = 0.34 + 0.03 * (i % 3)
    cubes[i] = body { name = "ice" .. i, box { size, size, round = 0.04 }, density = 917, color = "#cfe8f5",
        at = { -0.8 + 0.8 * ((i - 1) % 3), 0.35 + 0.62 * math.floor((i - 1) / 3) }, angle = 0.1 * i,
        temperature = 263, heat_capacity = 2100, conductance = 9000, melting_point = 273, latent_heat = 3.34e5, smallest = 0.06 }
    first = first + cubes[i]:mass()
end
local gone = 0
on_gone { a = "ice*", function(_, e) if e.how == "melted" then gone = gone + 1 end end }

local drop = 1000 * 0.03 * 0.03
local water = liquid_in(-9, -9, 9, 9) * 1000
local function ice()
    local sum = 0
    for i = 1, 6 do sum = sum + (cubes[i]:alive() and cubes[i]:mass() or 0) end
    return sum
end
expect { "what melts becomes water", always = true, test = function()
    local h, now = heat(), liquid_in(-9, -9, 9, 9) * 1000
    local off = math.abs(ice() - h.burnt + now - water + h.owed + h.gone - first)
    return off < 1e-3 * first, off, 1e-3 * first
end }
expect { "ice is never warmer than its melting point", body = "ice*", always = true, temperature = { 262.9, 273.0001 } }
expect { "heat is where it came from", at = 24, test = function()
    local h = heat()
    local off = math.abs(h.held - h.carried - h.content + first * 2100 * 263)
    return off < 1e-3 * h.held, off, 1e-3 * h.held
end }
expect { "nothing leaves the jar", at = 24, test = function() return liquid_in(-1.21, -0.02, 1.21, 99) == liquid_in(-9, -9, 9, 9) end }
expect { "a good part of it is water", at = 24, test = function() return ice() < 0.9 * first, ice(), 0.9 * first end }
expect { "the rest is in the pool", body = "ice*", at = 24, y = { 0, 0.8 }, max_speed = 0.3 }
