-- overlap_pyramid.lua - four rows of boxes that overlap by a quarter (Solver2D and Box2D: Overlap Recovery).
-- Fails: XPBD explodes, soft solvers may hop. Right: the pile opens at no more than some m/s and then lies.
-- lint: allow overlap: it begins so on purpose
scene { title = "Overlap Recovery", duration = 5 }
local rows, share = param("rows", 4, 1, 12), param("share", 0.25, 0, 0.9)
local wood = material { density = 600, friction = 0.6 }
body { type = "static", box { 40, 1 }, at = {0, -0.5}, material = wood }
local boxes, was, fastest = {}, {}, 0
for row = 0, rows - 1 do
    for i = 0, rows - row - 1 do
        boxes[#boxes + 1] = body { name = "box" .. #boxes, box { 1, 1 }, material = wood,
                                   at = {(i - (rows - row - 1) / 2) * (1 - share), 0.5 + row * (1 - share)} }
        was[#boxes] = {boxes[#boxes]:position()}
    end
end
every_step(function()
    fastest = 0
    for i, b in ipairs(boxes) do
        local x, y = b:position()
        fastest = math.max(fastest, math.abs(x - was[i][1]) * 60, math.abs(y - was[i][2]) * 60)
        was[i] = {x, y}
    end
end)
expect { "it opens gently", always = true, test = function() return fastest <= 6.01, fastest, 6.01 end }
expect { "nothing is thrown up", always = true, body = "box*", y = {0.45, rows + 0.25} }
expect { "it lies in the end", from = 4, test = function() return fastest <= 0.005, fastest, 0.005 end }
