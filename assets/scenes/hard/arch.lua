-- arch.lua - semicircular arches of 20 stones: by Milankovitch one stands from t / R = 0.1075 on (t: thickness, R: of its
-- middle line). Fails: soft joints between stones open as hinges: here it takes 0.13. Right: 0.115 stands, 0.095 falls.
scene { title = "Arches", duration = 8, sleep = false }
local stones = param("stones", 20, 5, 40)
local stone = material { density = 2000, friction = 0.9 }
body { type = "static", box { 120, 1 }, at = {0, -0.5}, material = stone }
local R = 5
local function arch(name, x, share)
    local inner, outer = R * (1 - share / 2), R * (1 + share / 2)
    for i = 1, stones do
        local a, b = math.pi * (i - 1) / stones, math.pi * i / stones
        body { name = name .. i, material = stone, at = {x, 0}, polygon {
            {inner * math.cos(a), inner * math.sin(a)}, {outer * math.cos(a), outer * math.sin(a)},
            {outer * math.cos(b), outer * math.sin(b)}, {inner * math.cos(b), inner * math.sin(b)} } }
    end
end
for k, share in ipairs { 0.095, 0.115, 0.13, 0.16 } do
    arch("arch" .. k .. "_", (k - 2) * 14, share)
    local key = ("arch%d_%d"):format(k, stones // 2)
    if share < 0.1075 then
        expect { ("t / R = %g falls"):format(share), body = key, y = {-5, -0.5} }
    else
        expect { ("t / R = %g stands"):format(share), body = key, y = {-0.5, 0.1} }
        expect { ("t / R = %g sags by 1 %% at most"):format(share), always = true, body = key, y = {-0.01 * R, 0.01 * R} }
    end
end
