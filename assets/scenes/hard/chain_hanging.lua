-- chain_hanging.lua - chains that hang straight, 20 links, with 10 to 10,000 times a link's mass below.
-- Fails: AVBD's heavy rope and Chipmunk's chains sag in proportion to the load; Jolt #1392 asks for lighter loads.
-- Right: links do not stretch; nothing swings, for nothing pushes sideways.
-- lint: allow mass-ratio: that is what it asks about
scene { title = "Loads on chains", duration = 4 }
local links = param("links", 20, 2, 100)
for k = 1, 4 do
    local ratio, x = math.pow(10, k), k * 3
    local last = body { type = "static", box { 0.2, 0.2 }, at = {x, 0.1} }
    for i = 1, links do
        local load = i == links
        local link = body { name = load and ("load" .. k) or ("link%d_%d"):format(k, i), box { 0.1, 0.4 },
                            at = {x, 0.2 - i * 0.4}, mass = load and ratio or 1, apart = "chain" }
        revolute { last, link, at = {x, 0.4 - i * 0.4} }
        last = link
    end
end
local y = 0.2 - links * 0.4
for k, name in ipairs { "10", "100", "1000", "10,000" } do
    expect { name .. " : 1 sags by 1 % at most", from = 1, body = "load" .. k, x = {k * 3 - 0.01, k * 3 + 0.01},
             y = {y * 1.01, y + 0.001} }
end
