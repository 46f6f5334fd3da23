-- chain_bridge_160.lua - Bridge of Solver2D: 160 planks in a row between two posts, let go level.
-- Fails: soft joints: it hangs metres low. Right: planks do not stretch: a level row that is as long as the gap cannot
-- sag; 2 % of sag is a thousandth of length.
scene { title = "Bridge of 160", duration = 6 }
local planks = param("planks", 160, 2, 200)
local banks = body { name = "banks", type = "static", box { 1, 1, at = {-0.5, -0.5} }, box { 1, 1, at = {planks + 0.5, -0.5} } }
local last = banks
for i = 1, planks do
    local plank = body { name = "plank" .. i, box { 1, 0.25 }, at = {i - 0.5, 0}, density = 20, apart = "bridge" }
    revolute { last, plank, at = {i - 1, 0} }
    last = plank
end
revolute { last, banks, at = {planks, 0} }
local low = 0
every_step(function()
    for i = 1, planks do
        local _, y = find("plank" .. i):position()
        low = math.min(low, y)
    end
end)
expect { "it sags by 2 % at most", test = function() return -low <= 0.02 * planks, -low / planks, 0.02 end }
expect { "nothing rises", always = true, body = "plank*", y = {-planks, 0.5} }
expect { "no hinge opens by 2 cm", always = true, max_joint_error = 0.02 }
