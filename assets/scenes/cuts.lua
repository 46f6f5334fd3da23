-- cuts.lua - bodies cut by lines, shattered and put together: a disc like a cake, a plank into laths, a U into three, a star and a tile
-- by places of Voronoi cells, a disc that becomes part of a box. What is cut moves on as the whole did: the parts
-- fly apart by their spin alone, and the sums of mass, momentum and angular momentum stay to rounding.
scene { title = "Cut, shattered, merged", gravity = {0, 0}, duration = 3, description = "Sums that stay, whatever is cut." }
local list = {}
local function add(def)
    def.velocity, def.collides = def.velocity or {0, 0}, {}
    list[#list + 1] = body(def)
    return list[#list]
end
local corners = {}
for i = 0, 13 do
    local r, a = i % 2 == 0 and 2 or 0.9, math.pi * i / 7
    corners[i + 1] = {r * math.cos(a), r * math.sin(a)}
end
local cake = add { name = "cake", circle { 1.6 }, at = {-6, 3}, spin = 0.5, color = "#d69e2e" }
local plank = add { name = "plank", box { 4.4, 0.7 }, at = {0, 3}, spin = 0.3, color = "#b7791f" }
local u = add { name = "u", outline { {-1.6, -1}, {1.6, -1}, {1.6, 1.6}, {0.8, 1.6}, {0.8, -0.2}, {-0.8, -0.2}, {-0.8, 1.6}, {-1.6, 1.6} },
                at = {6, 3}, spin = -0.4, color = "#2b6cb0" }
local star = add { name = "star", outline(corners), at = {-6, -2.6}, spin = 0.4, color = "#805ad5" }
local tile = add { name = "tile", box { 3.2, 3.2 }, at = {0, -2.6}, spin = -0.4, color = "#38a169" }
local two = add { name = "two", box { 1.5, 1.5 }, at = {5, -2.6}, spin = 1, velocity = {0.4, 0}, color = "#c53030" }
local other = add { name = "other", circle { 0.9 }, at = {7.4, -2.6}, velocity = {-0.5, 0.3}, color = "#dd6b20" }

local function sums()                       -- over all bodies, about the origin
    local m, px, py, l = 0, 0, 0, 0
    for _, b in ipairs(list) do
        local x, y = b:center()
        local vx, vy = b:velocity()
        m, px, py = m + b:mass(), px + b:mass() * vx, py + b:mass() * vy
        l = l + b:inertia() * b:spin() + b:mass() * (x * vy - y * vx)
    end
    return { m, px, py, l }
end
local function take(parts)
    for _, p in ipairs(parts) do list[#list + 1] = p end
end
local function cut(name, x, y, dx, dy)      -- all that is called so
    for _, b in ipairs({ table.unpack(list) }) do
        if b:name():sub(1, #name) == name then take(b:cut(x, y, dx, dy)) end
    end
end
local before, after, lost
at(1, function()
    before = sums()
    local x, y = cake:center()
    for i = 0, 3 do cut("cake", x, y, math.cos(math.pi * i / 4), math.sin(math.pi * i / 4)) end
    x, y = plank:center()
    for i = -2, 2 do cut("plank", x + 0.8 * i, y, 0.3, 1) end
    x, y = u:center()
    local c, s = math.cos(u:angle()), math.sin(u:angle())
    take(u:cut(x - 0.8 * s, y + 0.8 * c, c, s))
    x, y = star:center()
    take(star:shatter(x, y, 20, 5, 1))
    x, y = tile:center()
    take(tile:shatter(x - 1.2, y - 1.2, 40, 2))
    lost = two:merge(other)
    table.remove(list, 7)
    after = sums()
end)
camera { fit = {{-9, -5}, {9, 5.4}}, at = 2.4 }
for i, name in ipairs { "mass", "momentum along x", "momentum along y", "angular momentum" } do
    expect { name .. " stays", at = 1.1, test = function()
        local d = math.abs(after[i] - before[i])
        return d < 2e-5 * before[1], d, 2e-5 * before[1]
    end }
end
expect { "eight pieces of cake", at = 3, test = function() return find("cake.7") ~= nil and find("cake.8") == nil, body_count(), 0 end }
expect { "six laths", at = 3, test = function() return find("plank.5") ~= nil and find("plank.6") == nil, body_count(), 0 end }
expect { "a U cut across is three", at = 3, test = function() return find("u.2") ~= nil and find("u.3") == nil, body_count(), 0 end }
expect { "the blow costs energy", at = 3, test = function() return lost > 0, lost, 0 end }
