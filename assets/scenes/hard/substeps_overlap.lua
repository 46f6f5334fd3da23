-- substeps_overlap.lua - a row of discs that overlap by 5 % of their size, at 16 substeps, without gravity.
-- Fails: whoever grows stiffer with every substep parts them the faster, and leaves the speed. Right: they part, and
-- the speed with which they part is not motion that stays.
-- lint: allow overlap: it begins so on purpose
scene { title = "Overlap, 16 substeps", gravity = {0, 0}, duration = 3, substeps = 16 }
local n, share = param("n", 10, 2, 60), param("share", 0.05, 0.001, 0.9)
for i = 1, n do
    body { name = "disc" .. i, circle { 0.5 }, at = {(i - (n + 1) / 2) * (1 - share), 0} }
end
local half = (n - 1) / 2
expect { "the row has opened", test = function()
    local open = 0
    for i = 2, n do
        open = math.max(open, 1 - (find("disc" .. i):position() - find("disc" .. i - 1):position()))
    end
    return open <= 0.01, open, 0.01
end }
expect { "nobody flies on", always = true, body = "disc*", x = {-half - 0.25, half + 0.25} }
expect { "the row stays a row", always = true, body = "disc*", y = {-1e-3, 1e-3} }
