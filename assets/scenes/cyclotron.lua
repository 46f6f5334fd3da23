-- cyclotron.lua - a magnetic field between two halves of a disc turns charges round; an electric field in the gap, which changes its
-- sign as they come round, makes them faster, and their circles wider. The turn takes as long at any speed: 2 pi m / (q B).
scene { title = "Cyclotron", gravity = {0, 0}, duration = 12, dt = 1 / 240,
        description = "Charges spiral outwards, a turn a second." }
local w, field = 2 * math.pi, 30
body { name = "dees", type = "static", sensor = true, circle { 8 }, color = "#26304a" }
magnetic { strength = w, radius = 8 }
local gap = zone { electric = {field, 0}, half = {0.35, 8} }
for i = 1, 5 do
    body { name = "charge" .. i, circle { 0.12, category = "charge", collides = {} }, mass = 1, charge = 1, at = {-0.3, 0.1 * i},
           velocity = {1, 0}, color = i, sleep = false }
end
every_step(function() -- they go right above the middle, left below, half a turn later
    gap:set { electric = {field * (math.cos(w * time()) > 0 and 1 or -1), 0} }
end)
camera { fit = {{-12, -9}, {12, 9}}, at = 9, trail = 4 }
expect { "they get fast", body = "charge3", at = 5, min_speed = 20 }
