-- oblique_disc.lua - discs strike a wall obliquely, e = 0.6: with mu = 0.5 it grips (|vt| <= 3 mu (1 + e) vn): vt' = 2 vt
-- / 3; with mu = 0.1 it slips: vt' = vt - mu (1 + e) vn; spin by 2 (vt - vt') / r.
-- Source: Garwin, Am. J. Phys. 37 (1969) 88, for I = m r^2 / 2. Hard: friction within a blow.
-- Aim: 1e-3.
scene { title = "Oblique blows", gravity = {0, 0}, duration = 0.6, description = "Discs strike a wall with friction." }
local vn, vt, e, r = 3, 2, 0.6, 0.2
body { name = "wall", type = "static", box { 30, 1 }, at = {0, -0.5}, material = material { friction = 1, restitution = e } }
for i, case in ipairs { {"grips", 0.5}, {"slips", 0.1} } do
    local name, mu = case[1], case[2]
    body { name = name, circle { r }, at = {4 * i, 1}, velocity = {vt, -vn}, material = material { friction = mu * mu,
            restitution = e } }
    local after = vt <= 3 * mu * (1 + e) * vn and 2 / 3 * vt or vt - mu * (1 + e) * vn
    exact { name, body = name, vx = function() return after end, vy = function() return e * vn end, from = 0.35 }
    exact { name .. ", spin", body = name, spin = function() return -2 * (vt - after) / r end, from = 0.35 }
end
expect { "grips", exact = "grips", tolerance = 1.7e-07 }
expect { "grips, spin", exact = "grips, spin", tolerance = 2.4e-07 }
expect { "slips", exact = "slips", tolerance = 1.2e-07 }
expect { "slips, spin", exact = "slips, spin", tolerance = 4.3e-07 }
