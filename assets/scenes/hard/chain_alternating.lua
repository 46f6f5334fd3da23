-- chain_alternating.lua - a hanging rope whose links weigh 1 and 100 kg in turn (AVBD's spring and stack ratios).
-- Fails: solvers want masses to fall along the chain (Jolt #1392). Right: it hangs still.
-- lint: allow mass-ratio: that is what it asks about
scene { title = "Alternating chain 100 : 1", duration = 4 }
local links, ratio = param("links", 20, 2, 100), param("ratio", 100, 1, 1e6)
local last = body { type = "static", box { 0.2, 0.2 }, at = {0, 0.1} }
for i = 1, links do
    local link = body { name = "link" .. i, box { 0.1, 0.5 }, at = {0, 0.25 - i * 0.5}, apart = "chain",
                        mass = i % 2 == 0 and ratio or 1 }
    revolute { last, link, at = {0, 0.5 - i * 0.5} }
    last = link
end
local y = 0.25 - links * 0.5
expect { "it sags by 1 % at most", from = 1, body = "link" .. links, y = {y * 1.01, y + 0.001} }
expect { "nothing swings", always = true, body = "link*", x = {-0.01, 0.01} }
expect { "no joint comes apart by 2 cm", always = true, max_joint_error = 0.02 }
