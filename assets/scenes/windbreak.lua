-- windbreak.lua - a board keeps the wind off what lies behind it: near by nearly all of it, farther off less.
-- Shows: shelter and wake of a fluid, crates that slide where friction holds no longer, leaves that fall into the lee.
scene { title = "Windbreak", dt = 1 / 60, duration = 4,
        description = "Crates in a wind of 9 m/s: one before a board, one in its lee, one farther down the wind." }
camera { fit = {{-4, -0.6}, {11, 3.6}}, at = 0.9, trail = 0.3 }

local SPEED, DRAG, AIR, SHELTER, WAKE = 9, 2, 1.2, 0.9, 0.1
local MU, DENSITY, W, H = 0.3, 20, 1.2, 0.4 -- crates
local wood = material { friction = MU, density = DENSITY }
local leaf = material { friction = 0.8, density = 4 }
wind { box { 40, 12 }, at = {0, 6}, flow = {SPEED, 0}, density = AIR, drag = DRAG, skin_drag = 0, shelter = SHELTER, wake = WAKE }
body { type = "static", name = "ground", box { 60, 1, material = wood }, at = {0, -0.5} }
body { type = "static", name = "board", box { 0.1, 0.6, material = wood }, at = {0, 0.3}, color = 3 }
local open = body { name = "open", box { W, H, material = wood }, at = {-3, H / 2}, color = 1 }
local lee = body { name = "lee", box { W, H, material = wood }, at = {1.4, H / 2}, color = 2 }
local far = body { name = "far", box { W, H, material = wood }, at = {8.4, H / 2}, color = 5 }
for i = 1, 36 do
    body { polygon { {-0.12, 0}, {0, -0.03}, {0.12, 0}, {0, 0.03}, material = leaf }, angle = random(0, 6), ignores = "leaf", category = "leaf",
           at = {random(-7, 1), random(1, 4.5)}, color = i % 3 == 0 and "#d98a2b" or i % 3 == 1 and "#b5452c" or "#8aa33b" }
end

-- [N] of the wind on a crate at a distance x behind what is 2 r high, by Jensen's law, and of friction.
local function push(r, x)
    local share = SHELTER * (r / (r + WAKE * x)) ^ 2
    return AIR * DRAG / 2 * (SPEED * (1 - share)) ^ 2 * H
end
local hold = MU * DENSITY * W * H * 9.81

expect { "theory: the wind moves what is before the board and far behind it, and nothing in its lee", at = 0.1,
         test = function() return push(0.3, 0.75) < hold and push(0.2, 5.8) > hold and push(0, 1) > hold end }
expect { "what lies in the lee stays", at = 4, test = function()
    local way = math.abs(lee:position() - 1.4)
    return way < 2e-3, way, 2e-3
end }
expect { "what lies farther off slides", at = 4, test = function()
    local way = far:position() - 8.4
    return way > 0.3, way, 0.3
end }
expect { "what lies before it is pressed to it", at = 4, test = function()
    local gap = (-0.05 - W / 2) - open:position()
    return math.abs(gap) < 0.02, gap, 0.02
end }
