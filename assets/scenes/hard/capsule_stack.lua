-- capsule_stack.lua - 20 capsules that lie on one another (Box2D: Capsule Stack): long flat sides, round ends.
-- Fails: one contact point where two are, so that they see-saw. Right: they lie.
scene { title = "Capsule stack", duration = 8, sleep = false }
local n = param("n", 20, 1, 60)
body { type = "static", box { 40, 1 }, at = {0, -0.5} }
for i = 1, n do body { name = "capsule" .. i, capsule { 1, 0.25 }, at = {0, (i - 0.5) * 0.5} } end
expect { "they lie level", always = true, body = "capsule*", x = {-0.02, 0.02}, angle = {-0.02, 0.02} }
expect { "the top is on top", body = "capsule" .. n, y = {(n - 0.5) * 0.495, (n - 0.5) * 0.5 + 0.001} }
