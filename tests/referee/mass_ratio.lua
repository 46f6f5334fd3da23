-- mass_ratio.lua - a crate under a crate of `ratio` times its mass: how far the upper one sinks, as a share of the lower one's
-- height. Right: not at all, whatever the ratio.
-- lint: allow mass-ratio: that is what it asks about
scene { title = "Heavy on light", duration = 3, sleep = false }
local ratio = param("ratio", 100, 1, 1e6)
body { type = "static", box { 20, 1 }, at = {0, -0.5} }
body { name = "light", box { 1, 1 }, at = {0, 0.5}, mass = 100 }
body { name = "heavy", box { 1, 1 }, at = {0, 1.5}, mass = 100 * ratio }
expect { "it sinks by 2 % at most", test = function()
    local x, y = find("heavy"):position()
    local sink = math.abs(x) > 1 and 1 or math.abs(1.5 - y)
    return sink <= 0.02, sink, 0.02
end }
