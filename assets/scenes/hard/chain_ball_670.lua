-- chain_ball_670.lua - Ball & Chain of Solver2D and Box2D: 40 links, and a ball of 670 times a link at the end, let
-- go from level. Fails: TGS-soft chains give by metres, XPBD needs many substeps. Right: the chain is as long as it was.
-- lint: allow mass-ratio: that is what it asks about
scene { title = "Ball & Chain 670 : 1", duration = 6 }
local links, ratio = param("links", 40, 2, 200), param("ratio", 670, 1, 1e6)
local last = body { type = "static", circle { 0.1 }, at = {0, 0}, apart = "chain" }
for i = 1, links do
    local link = body { name = "link" .. i, capsule { 0.8, 0.125 }, at = {i - 0.5, 0}, mass = 6, apart = "chain" }
    revolute { last, link, at = {i - 1, 0} }
    last = link
end
local ball = body { name = "ball", circle { 2 }, at = {links + 2, 0}, mass = 6 * ratio, apart = "chain" }
revolute { last, ball, at = {links, 0} }

local farthest, length = 0, links + 2
every_step(function()
    local x, y = ball:position()
    farthest = math.max(farthest, math.sqrt(x * x + y * y))
end)
expect { "the chain lengthens by 5 % at most", test = function()
    return farthest <= 1.05 * length, farthest / length, 1.05
end }
expect { "the ball never rises above its start", always = true, body = "ball", y = {-1.1 * length, 0.02 * length} }
expect { "no joint comes apart by 5 cm", always = true, max_joint_error = 0.05 }
