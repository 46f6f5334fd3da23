-- bowl_cloth.lua - three cloths, seen from their edges, fall over a bowl, a ball on a stand and a table, and come to rest.
-- Shows: thin sheets as rope{} with a little bending: they drape, hold by friction alone, and sleep. What hangs from an edge
-- pulls there with its weight; on its way over the edge tension changes by e^(friction times angle) at the most.
scene { title = "Cloths over a bowl, a ball and a table", duration = 9,
        description = "Three cloths fall, drape what is below them and fall asleep." }
camera { fit = {{-4.4, -0.3}, {4.4, 3.3}}, at = 3.5 }
local g, friction, weight = 9.81, 0.4, 0.6 -- [kg/m] of cloth
local glaze = material { name = "glaze", friction = friction }

body { name = "floor", type = "static", box { 14, 0.5, at = {0, -0.25} }, color = "#8d7f70" }
local middle_of_bowl = -2.9
-- The bowl: a half ring, its rims rounded, on a foot.
local points, r, thick = {}, 1, 0.12
for i = 0, 24 do
    local a = -math.pi + math.pi * i / 24
    points[#points + 1] = { (r + thick) * math.cos(a), (r + thick) * math.sin(a) }
end
for i = 24, 0, -1 do
    local a = -math.pi + math.pi * i / 24
    points[#points + 1] = { r * math.cos(a), r * math.sin(a) }
end
body { name = "bowl", type = "static", at = {middle_of_bowl, 1.62}, material = glaze, color = "#3f7fae", outline(points),
       circle { 0.09, at = {-1.06, 0} }, circle { 0.09, at = {1.06, 0} }, box { 0.9, 0.5, at = {0, -1.37} } }
body { name = "ball", type = "static", circle { 0.6 }, at = {0, 2}, material = glaze, color = "#d6a13b" }
body { name = "stand", type = "static", box { 0.2, 1.5, at = {0, 0.75} }, box { 0.9, 0.12, at = {0, 0.06} }, color = "#6d6157" }
body { name = "table", type = "static", box { 1.9, 0.08, at = {2.9, 1.6}, round = 0.05 }, box { 0.1, 1.52, at = {2.2, 0.76} },
       box { 0.1, 1.52, at = {3.6, 0.76} }, material = glaze, color = "#a8794f" }

local nodes, stiffness = 61, 2e4 -- [N] of a strain of 1
local function drape(x, y, width, color)
    return rope { from = {x - width / 2, y}, to = {x + width / 2, y}, nodes = nodes, mass = weight * width, stiffness = stiffness, damping = 20,
                  bending = 0.01, drag = 2.5, radius = 0.035, friction = friction, color = color }
end
local cloths = { drape(middle_of_bowl, 3, 4.6, "#c04563"), drape(0, 3.2, 3.6, "#2f8f6b"), drape(2.9, 3, 3.8, "#7a55a8") }
for i = 1, 3 do body { name = "apple" .. i, circle { 0.2 }, at = {middle_of_bowl - 0.8 + 0.4 * i, 1.2}, density = 20, material = glaze, label = " ",
                         color = i == 2 and "#8fae3c" or "#c8452f" } end

for i, what in ipairs { "bowl", "ball", "table" } do
    local cloth = cloths[i]
    expect { "over the " .. what .. " both ends hang down evenly", at = 9, test = function()
        local _, left = cloth:node(1)
        local _, right = cloth:node(nodes)
        return math.abs(left - right) < 0.05, left - right, 0.05
    end }
    expect { "over the " .. what .. " its tension stretches it", at = 9, test = function()
        local m = cloth:measure()
        local off = math.abs(m.strain * stiffness / m.tension - 1)
        return off < 0.04, off, 0.04
    end }
    expect { "over the " .. what .. " it sleeps", at = 9, test = function() return not cloth:awake() end }
end
-- A cloth that slides pulls at the top with the weight of as much as hangs below; friction takes of it.
for i, top in ipairs { 2.635, 1.725 } do
    expect { "no more than what hangs down pulls at the top of " .. (i == 1 and "the ball" or "the table"), at = 9, test = function()
        local _, y = cloths[i + 1]:node(1)
        local most = weight * g * (top - y)
        local pull = cloths[i + 1]:measure().tension
        return pull < 1.02 * most and pull > 0.5 * most, pull, most
    end }
end
-- In the mouth of the bowl it is a catenary: of a half length l that sags by s it pulls with w (l^2 + s^2) / (2 s).
expect { "friction on the rims holds up a catenary", at = 9, test = function()
    local i, middle = 1, (nodes + 1) / 2
    while cloths[1]:node(i) < middle_of_bowl - 0.97 do i = i + 1 end
    local _, y = cloths[1]:node(i)
    local _, low = cloths[1]:node(middle)
    local l, s = (middle - i) * 4.6 / (nodes - 1), y - low
    local theory, pull = weight * g * (l * l + s * s) / (2 * s), cloths[1]:measure().tension
    return math.abs(pull / theory - 1) < 0.03, pull, theory
end }
-- What hangs over the rim holds that at most by e^(friction angle): from upright over the top to half a right angle.
expect { "and no more than friction can", at = 9, test = function()
    local _, y = cloths[1]:node(1)
    local most = weight * g * (1.745 - y) * math.exp(friction * 0.75 * math.pi)
    local pull = cloths[1]:measure().tension
    return pull < most, pull, most
end }
expect { "the apples lie in the bowl", body = "apple*", x = {-3.9, -1.9}, y = {0.8, 1.4} }
