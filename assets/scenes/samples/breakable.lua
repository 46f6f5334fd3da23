-- breakable.lua - loads hang on ropes, hinges, welds and slides that bear 200 N: those of 160 and 190 N hold, those of 210
-- and 240 N break theirs at once; arms that are welded at one end break by torque, from 100 N m on.
scene { title = "Breakable joints", duration = 4 }
camera { fit = {{-2, -6.5}, {20, 3}}, at = 0.5 }
body { type = "static", box { 60, 1 }, at = {8, -6} }
local makers = {
    function(b, x, k, name) return distance { world, b, at_a = {x, 2}, name = name, break_force = 200 } end,
    function(b, x, k, name) return revolute { b, at = {x, 2}, name = name, break_force = 200 } end,
    function(b, x, k, name) return weld { b, at = {x, 0}, name = name, break_force = 200 } end,
    function(b, x, k, name) return prismatic { b, at = {x, 0}, axis = {1, 0}, name = name, break_force = 200 } end,
}
local kinds = { "rope", "hinge", "weld", "slide" }
for j, make in ipairs(makers) do
    for k, load in ipairs { 160, 190, 210, 240 } do
        local x, name = 1.05 * (k - 1) + 4.5 * (j - 1), ("%s_%d"):format(kinds[j], load)
        local b = body { name = name, box { 0.6, 0.6 }, at = {x, 0}, mass = load / 9.81, color = load < 200 and 2 or 1, collides = "default" }
        make(b, x, k, name)
        expect { ("%s under %d N %s"):format(kinds[j], load, load < 200 and "holds" or "breaks"), joint = name, broken = load < 200 and 0 or 1 }
        if load < 200 then expect { ("its load stays, %s %d"):format(kinds[j], load), always = true, body = name, y = 0, tolerance = 0.03 } end
    end
end
for k, torque in ipairs { 80, 95, 105, 120 } do -- arms of 1 m, the weight in their middle
    local name = ("arm_%d"):format(torque)
    weld { body { name = name, box { 1, 0.2 }, at = {19 - 0.5, 2.6 - 0.7 * k}, mass = torque / 0.5 / 9.81, color = torque < 100 and 2 or 1, apart = "arms" },
           at = {19, 2.6 - 0.7 * k}, name = name, break_torque = 100 }
    expect { ("an arm under %d N m %s"):format(torque, torque < 100 and "holds" or "breaks"), joint = name, broken = torque < 100 and 0 or 1 }
end
expect { "ten are broken", broken = 10 }
expect { "what broke lies below", body = "rope_240", y = -5.2, tolerance = 0.01 }
