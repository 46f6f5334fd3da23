-- overlap_row.lua - a row of boxes that overlap by a quarter (Solver2D's Overlap Recovery laid flat), default settings.
-- Fails: XPBD and Baumgarte solvers throw them apart. Right: they part gently and lie where they part.
-- lint: allow overlap: it begins so on purpose
scene { title = "Overlap undone", gravity = {0, 0}, duration = 4 }
local n, share = param("n", 6, 2, 60), param("share", 0.25, 0.001, 0.95)
for i = 1, n do
    body { name = "box" .. i, box { 1, 1 }, at = {(i - (n + 1) / 2) * (1 - share), 0} }
end
local half = (n - 1) / 2
expect { "the row has opened", test = function()
    local left = find("box1"):position()
    local right = find("box" .. n):position()
    return right - left >= 2 * half - 0.01 * n, right - left, 2 * half - 0.01 * n
end }
expect { "nobody flies on", always = true, body = "box*", x = {-half - 0.25, half + 0.25} }
expect { "nothing turns", always = true, body = "box*", angle = {-0.01, 0.01} }
