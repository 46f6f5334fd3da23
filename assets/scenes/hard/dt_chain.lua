-- dt_chain.lua - a chain of 20 links with 100 times a link's mass at its end hangs; then steps are 16 times shorter.
-- Fails: whoever ties the stiffness of joints to the step: stored stretch is set free. Right: it hangs on.
-- lint: allow mass-ratio: that is what it asks about
scene { title = "A loaded chain, 60 Hz to 960 Hz", duration = 3 }
local links, parts, ratio = param("links", 20, 1, 60), param("parts", 16, 1, 1000), param("ratio", 100, 1, 1e6)
local last = body { type = "static", box { 0.2, 0.2 }, at = {0, 0.1} }
local load
for i = 1, links do
    load = body { name = "link" .. i, box { 0.1, 0.5 }, at = {0, 0.25 - i * 0.5}, mass = i == links and ratio or 1,
                  apart = "chain" }
    revolute { last, load, at = {0, 0.5 - i * 0.5} }
    last = load
end
at(1, function() split_step(parts) load:wake() end)

expect { "the load never rises", always = true, body = "link" .. links, y = {-links, 0.25 - links * 0.5 + 0.01} }
expect { "the load hangs where it should", from = 0.5, body = "link" .. links, y = 0.25 - links * 0.5,
         tolerance = 0.01 * links * 0.5 }
expect { "no joint comes apart", always = true, max_joint_error = 0.005 }
