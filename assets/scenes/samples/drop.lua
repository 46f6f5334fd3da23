-- drop.lua - four things fall from 50 m onto thin planks on posts: a disc, a box, a capsule and a concave bracket, and
-- dolls of three parts besides. Nothing goes through the planks, nothing is pressed into them.
scene { title = "Drop", duration = 8 }
camera { fit = {{-14, -1}, {14, 8}}, at = 3.4, trail = 0.3 }
body { type = "static", box { 60, 1 }, at = {0, -0.5} }
local oak = material { friction = 0.8, rolling_resistance = 0.05 }
for i = 1, 6 do body { name = "plank" .. i, type = "static", box { 3.6, 0.1 }, at = {4 * i - 14, 2}, material = oak, color = "#c08a4a" } end
local things = { circle { 0.4 }, box { 0.8, 0.8 }, capsule { 0.8, 0.25 },
                 outline { {-0.6, -0.6}, {0.6, -0.6}, {0.6, -0.3}, {-0.3, -0.3}, {-0.3, 0.6}, {-0.6, 0.6} } }
for i, thing in ipairs(things) do body { name = "thing" .. i, thing, at = {4 * i - 14, 50}, material = oak, color = i } end
for i = 5, 6 do -- dolls
    local x, last = 4 * i - 14, nil
    for p = 1, 3 do
        local limb = body { name = ("doll%d_%d"):format(i, p), capsule { 0.5, 0.15 }, at = {x + 0.5 * p - 1, 50}, apart = "doll" .. i, material = oak, color = i }
        if last then revolute { last, limb, at = {x + 0.5 * p - 1.25, 50}, limits = {-0.8, 0.8} } end
        last = limb
    end
end
expect { "nothing goes through a plank", always = true, body = "thing*", y = {2.05, 51} }
expect { "nor does a limb", always = true, body = "doll*", y = {2.05, 51} }
expect { "what fell has bounced by less than it fell", from = 3.3, body = "thing*", y = {2.05, 4} }
expect { "the dolls hold together", always = true, max_joint_error = 0.1 }
expect { "all lie still", max_speed = 0.05, max_penetration = 0.01 }
