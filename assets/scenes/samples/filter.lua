-- filter.lua - who meets whom: a team passes through its own and lands on the other; odd boxes pass even ones; a pair that is
-- excluded overlaps; later a filter is changed, and what stood falls through.
scene { title = "Filters", duration = 5 }
camera { fit = {{-7, -6}, {12, 7}}, at = 1.9 }
body { name = "ground", type = "static", box { 60, 1 }, at = {0, -0.5}, category = "ground" }
body { name = "cellar", type = "static", box { 60, 1 }, at = {0, -5.5}, category = "cellar" }
local function team(name, x, y, category, color, ignores)
    return body { name = name, box { 1.5, 1 }, at = {x, y}, category = category, ignores = ignores, color = color }
end
team("red low", -5, 0.5, "red", 1, "red")
team("red high", -5, 3, "red", 1, "red") -- falls into its own
team("blue low", -2, 0.5, "blue", 2, "blue")
team("red on blue", -2, 3, "red", 1, "red") -- lands on the other
for i = 1, 6 do -- each passes its neighbours below
    body { name = "parity" .. i, box { 1, 1 }, at = {2, 0.6 + 1.2 * (i - 1)}, category = i % 2 == 0 and "even" or "odd",
           ignores = i % 2 == 0 and "odd" or "even", color = 2 + i % 2 }
end
local a = body { name = "a", box { 1, 1 }, at = {5, 0.5}, color = 5 }
local b = body { name = "b", box { 1, 1 }, at = {5, 2}, color = 6 }
exclude(a, b)
local trap = body { name = "trap", box { 1, 1 }, at = {9, 0.5}, color = 7 }
at(2, function() trap:set_filter { collides = "cellar" } end)
expect { "red passes red", body = "red high", y = 0.5, tolerance = 0.01 }
expect { "red lands on blue", body = "red on blue", y = 1.5, tolerance = 0.01 }
for i = 1, 6 do -- stacks of three, one in the other
    expect { ("box %d lies on its own kind"):format(i), body = "parity" .. i, y = (i - 1) // 2 + 0.5, x = 2, tolerance = 0.02 }
end
expect { "an excluded pair overlaps", body = "b", y = 0.5, tolerance = 0.01 }
expect { "before, the trap holds", at = 1.9, body = "trap", y = 0.5, tolerance = 0.01 }
expect { "after, it falls into the cellar", body = "trap", y = -4.5, tolerance = 0.01 }
