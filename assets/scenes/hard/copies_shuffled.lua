-- copies_shuffled.lua - a pyramid, and the same with its boxes made in another order; both settle.
-- Fails: Gauss-Seidel that depends on the order of making. Right: order is no physics: they end alike.
scene { title = "Shuffled copies", duration = 4, seed = 4 }
local wood = material { density = 600, friction = 0.6 }
local rows = param("rows", 8, 2, 20)
local copies = { {}, {} }
for k = 1, 2 do
    local cx, order = k * 40, {}
    body { type = "static", box { 38, 1 }, at = {cx, -0.5}, material = wood }
    for row = 1, rows do
        for i = 1, rows - row + 1 do order[#order + 1] = { row, i } end
    end
    if k == 2 then
        for i = #order, 2, -1 do
            local j = random_int(1, i)
            order[i], order[j] = order[j], order[i]
        end
    end
    for _, o in ipairs(order) do
        copies[k][("%d_%d"):format(o[1], o[2])] = body { box { 1, 1 }, material = wood,
                                                at = {cx + (o[2] - (rows - o[1] + 2) / 2) * 1.05, o[1] - 0.5} }
    end
end
expect { "they stand alike within 1 cm", test = function()
    local off = 0
    for key, b in pairs(copies[1]) do
        local x, y = b:position()
        local u, v = copies[2][key]:position()
        off = math.max(off, math.abs(x - u + 40), math.abs(y - v))
    end
    return off <= 0.01, off, 0.01
end }
