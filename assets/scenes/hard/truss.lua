-- truss.lua - a girder of bars and hinges, 12 m long, from one support to the other, with a load at its middle.
-- Fails: soft joints: it sags by 1.5 m (Box2D 2.1 m). Right: rigid bars: no sag.
-- lint: allow mass-ratio: the load is what it asks
scene { title = "Truss", duration = 5 }
local n, load = param("n", 12, 2, 40), param("load", 500, 0, 1e6)
local anchor = body { type = "static", circle { 0.1 }, circle { 0.1, at = {n, 0} }, apart = "truss" }
local at_node = {}
local function bar(x1, y1, x2, y2)
    local dx, dy = x2 - x1, y2 - y1
    local length = math.sqrt(dx * dx + dy * dy)
    local made = body { name = ("bar_%g_%g_%g_%g"):format(x1, y1, x2, y2), capsule { length, 0.04 }, mass = 10 * length,
                        at = {(x1 + x2) / 2, (y1 + y2) / 2}, angle = math.atan(dy, dx), apart = "truss" }
    for _, p in ipairs { {x1, y1}, {x2, y2} } do
        local key = ("%g %g"):format(p[1], p[2])
        if at_node[key] then revolute { at_node[key], made, at = p } end
        at_node[key] = at_node[key] or made
    end
    return made
end
for i = 1, n do bar(i - 1, 0, i, 0) end
for i = 1, n do
    bar(i - 1, 0, i - 0.5, 1)
    bar(i - 0.5, 1, i, 0)
    if i < n then bar(i - 0.5, 1, i + 0.5, 1) end
end
revolute { anchor, at_node["0 0"], at = {0, 0} }
revolute { anchor, at_node[("%g 0"):format(n)], at = {n, 0} }
local middle = math.floor(n / 2)
local weight = body { name = "weight", circle { 0.4 }, at = {middle, -1}, mass = load, apart = "truss" }
distance { at_node[("%g 0"):format(middle)], weight, at_a = {middle, 0}, at_b = {middle, -1} }

expect { "the load sags by 2 cm at most", from = 1, body = "weight", y = {-1.02, -0.98} }
expect { "no hinge opens by 1 cm", always = true, max_joint_error = 0.01 }
expect { "nothing swings sideways", body = "weight", x = middle, tolerance = 0.02 }
