-- soft_walker.lua - an inchworm of jelly walks past its twin: it grips with its front foot as it draws up, with its hind foot as it stretches.
-- Shows: jelly{} held by bodies, a spring as its muscle whose rest a handler changes, materials that change. The twin works as hard, but
-- grips with both feet alike: it stays where it is.
scene { title = "Soft walker", duration = 12, description = "An inchworm of jelly draws itself up and stretches; its twin does not let go of the ground, and stays." }
camera { fit = {{-1.2, -1.75}, {3.6, 0.9}}, at = 7.1 }
local long, short, period, begin = 1.3, 0.85, 1.2, 0.5 -- [m] between the feet, [s]

local function worm(name, y0, grips, color)
    body { name = name .. " ground", label = " ", type = "static", box { 4.7, 0.15, at = {1.2, y0 - 0.075} }, material = material { friction = 1 }, color = "#a58a5f" }
    local back = jelly { box { long, 0.2, at = {0, y0 + 0.22} }, spacing = 0.1, density = 100, young = 6e4, damping = 0.05, friction = 0.3, color = color }
    local feet = {}
    for i = 1, 2 do
        local x = i == 1 and -long / 2 or long / 2
        local skin = material { friction = 0.5, friction_mix = "min", density = 500 }
        local who = name .. (i == 1 and " hind" or " front")
        local foot = body { name = who, label = " ", at = {x, y0 + 0.05}, box { 0.18, 0.1 }, material = skin, color = "#5b4636" }
        feet[i] = { body = foot, skin = skin }
        expect { who .. " foot stays on the ground", always = true, body = who, y = {y0 - 0.02, y0 + 0.18} }
        for n = 1, (back:count()) do
            local nx, ny = back:node(n)
            if math.abs(nx - x) < 0.11 and ny < y0 + 0.17 then back:hold(n, nx - x, ny - y0 - 0.05, foot) end
        end
    end
    local muscle = distance { feet[1].body, feet[2].body, spring = { stiffness = 4000, damper = 150 } }
    every_step(function(t)
        if t < begin then return end
        local phase = (t - begin) / period % 1
        muscle:set_rest(phase < 0.5 and short or long)
        if grips then
            feet[1].skin:set { friction = phase < 0.5 and 0.05 or 1 }
            feet[2].skin:set { friction = phase < 0.5 and 1 or 0.05 }
        end
    end)
    return back
end
local walker = worm("walker", 0, true, "#7cb342")
local twin = worm("twin", -1.4, false, "#b0a8c8")

local function x_of(back) return back:measure().x end
expect { "the worm walks", at = 12, test = function() return x_of(walker) > 1.2, x_of(walker), 1.2 end }
expect { "step by step", at = 6.5, test = function() return x_of(walker) > 0.5 and x_of(walker) < 1.6, x_of(walker), 0.5 end }
expect { "its twin stays where it is", always = true, test = function() return math.abs(x_of(twin)) < 0.02, x_of(twin), 0.02 end }
expect { "its back arches as it draws itself up", at = 4.6, test = function()
    local y = walker:measure().y
    return y > 0.35, y, 0.35
end }
