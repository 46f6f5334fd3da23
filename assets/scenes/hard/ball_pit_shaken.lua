-- ball_pit_shaken.lua - a closed box of 150 discs and boxes, shaken to and fro by 30 cm at 3 Hz.
-- Fails: things squeezed between a driven wall and the heap leave through it, or are thrown at tens of m/s.
-- Right: all stay inside; when the shaking stops the pit comes to rest.
scene { title = "Shaken ball pit", duration = 11, seed = 11 }
local n, reach, hertz = param("n", 150, 1, 600), param("reach", 0.3, 0, 2), param("hertz", 3, 0, 20)
local pit = body { name = "pit", type = "kinematic", box { 9, 1, at = {0, -0.5} }, box { 9, 1, at = {0, 8.5} },
                   box { 1, 8, at = {-4, 4} }, box { 1, 8, at = {4, 4} } }
local things, was, fastest, worst = {}, {}, 0, 0
for i = 0, n - 1 do
    local r = random(0.15, 0.25)
    things[i + 1] = body { name = "thing" .. i, i % 2 == 0 and circle { r } or box { 2 * r, 2 * r },
                           at = {(i % 12 - 5.5) * 0.55, 0.4 + (i // 12) * 0.55}, density = 100 }
end
every_step(function(t)
    fastest = 0
    for i, b in ipairs(things) do
        local x, y = b:position()
        if was[i] then fastest = math.max(fastest, math.abs(x - was[i][1]) * 60, math.abs(y - was[i][2]) * 60) end
        was[i] = {x, y}
    end
    worst = math.max(worst, fastest)
    local driven = 2 * math.pi * hertz * reach
    pit:set_velocity(t < 4 and driven * math.cos(2 * math.pi * hertz * t) or 0, 0)
end)
expect { "all stay inside", always = true, test = function()
    local px, out = select(1, pit:position()), 0
    for _, b in ipairs(things) do
        local x, y = b:position()
        if not (math.abs(x - px) < 3.5 and y > 0 and y < 8) then out = out + 1 end
    end
    return out == 0, out, 0
end }
expect { "nothing is shot", test = function() return worst <= 25, worst, 25 end }
expect { "the pit comes to rest", from = 10.5, test = function() return fastest <= 0.05, fastest, 0.05 end }
