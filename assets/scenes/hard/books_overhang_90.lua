-- books_overhang_90.lua - books over the edge of a table, each by w / 2k, as far as statics lets them, times a share.
-- Fails: soft contacts press in at the edges: here 0 of the theoretical overhang holds with 10 books. Right: 0.9 of it
-- stands, 1.1 falls.
scene { title = "Books near the overhang", duration = 6 }
local n = param("n", 10, 1, 20)
local paper = material { density = 700, friction = 0.6 }
body { type = "static", box { 6, 1, at = {-3, -0.5} }, box { 6, 1, at = {7, -0.5} }, material = paper }
local function pile(name, edge, share, dir)
    for k = n, 1, -1 do -- k books lie from here up; their middle is over the edge of what is below
        local i = n - k + 1
        local over = 0
        for j = k, n do over = over + 1 / (2 * j) end
        body { name = name .. i, box { 1, 0.2 }, material = paper, at = {edge + dir * (share * over - 0.5), i * 0.2 - 0.1} }
    end
end
pile("a", 0, 0.9, 1)
pile("b", 4, 1.1, -1)
expect { "0.9 of the overhang stands", body = "a*", y = {0.05, 0.2 * n}, angle = {-0.05, 0.05} }
expect { "the top one has not moved", body = "a" .. n, y = 0.2 * n - 0.1, tolerance = 0.01 }
expect { "1.1 of the overhang falls", body = "b" .. n, y = {-1e4, 0} }
