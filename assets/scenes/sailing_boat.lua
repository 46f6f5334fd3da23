-- sailing_boat.lua - a boat runs before a gusty wind, over a swell; its sail bellies.
-- Shows: wind{} on a rope{} that a body holds at two places, by the wind that is felt on board; waves{} that a hull rides and makes.
scene { title = "Sailing boat", description = "A boat runs before the wind, in gusts and a swell.", duration = 20, seed = 4 }
camera { follow = "boat", height = 9.5, at = 13 }
local wood = material { density = 300, friction = 0.5 }
local lead = material { density = 6000, friction = 0.5 }
local sea = water { name = "sea", drag = 0.1, box { 70, 6 }, at = {5, -3} } -- a slender hull
waves { body = sea, modes = 128, swell = 0.15, swell_length = 8 }
local blow = 8
wind { category = "blow", box { 70, 14 }, at = {5, 7}, flow = {blow, 0}, gust = 0.25, gust_length = 12 }

-- A keel of lead keeps her upright.
body { name = "boat", at = {-20, 0.1}, color = "#b5793f",
    polygon { {-2, 0.45}, {-1.5, -0.35}, {1.5, -0.35}, {2.2, 0.55}, material = wood },
    box { 0.5, 0.2, at = {0, -0.45}, material = lead },
    box { 0.1, 4, at = {0, 2.4}, material = wood } }
-- 100 N a m/s: four times as much as 4 m of canvas have in this wind, for a hull in two dimensions has no way round it for the water.
local sail = rope { from = {-19.9, 4.4}, to = {-18.2, 0.65}, from_body = "boat", to_body = "boat", hold = "both", length = 4.8, nodes = 24, mass = 1.5,
                    stiffness = 2e4, drag = 100 / 1.5, radius = 0.04, color = "#c0392b", collides = "blow" }

local slackest = 9
every(1 / 10, function(t)
    if t < 2 then return end
    local mid_x, top_x, foot_x = sail:node(12), sail:node(1), sail:node(24)
    slackest = math.min(slackest, mid_x - (top_x + foot_x) / 2)
end)
expect { "she keeps upright", from = 1, body = "boat", angle = {-0.5, 0.5} }
expect { "rides the swell", always = true, body = "boat", y = {-0.7, 0.7} }
expect { "makes way before the wind", at = 20, body = "boat", x = {-12, 20} }
expect { "and is slower than the wind", always = true, body = "boat", max_speed = blow / 2 }
expect { "her sail bellies forward at all times", at = 20, test = function() return slackest > 0.3, slackest, 0.3 end }
-- 800 N along 4.2 m of an arc of 2 m: a tension of 380 N, of 2e4; peaks of gusts and her pitching at most treble it.
expect { "which stretches as the pull says", from = 2, test = function() local m = sail:measure() return m.strain < 0.057, m.strain, 0.057 end }
