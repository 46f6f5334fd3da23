-- mass_pairs.lua - a box of 10 to 1,000,000 times the mass stands on a light one of the same size.
-- Fails: soft contacts from 30 : 1 on (Box2D 10 : 1, DART's SI from 100 : 1, godot-jolt #1041 at 60 : 1).
-- Right: the light one bears it: no more overlap than a hundredth of its height, whatever the ratio.
-- lint: allow mass-ratio: that is what it asks about
scene { title = "Heavy on light", duration = 4 }
body { type = "static", box { 60, 1 }, at = {0, -0.5} }
for k = 1, 6 do
    body { name = "light" .. k, box { 1, 1 }, at = {4 * k - 14, 0.5}, mass = 1 }
    body { name = "heavy" .. k, box { 1, 1 }, at = {4 * k - 14, 1.5}, mass = math.pow(10, k) }
end
for k = 1, 6 do
    expect { ("%d : 1 stands"):format(math.floor(math.pow(10, k) + 0.5)), from = 0.1, body = "heavy" .. k,
             x = {4 * k - 14.01, 4 * k - 13.99}, y = {1.48, 1.501} }
end
expect { "no light one is pushed into the ground", always = true, body = "light*", y = {0.48, 0.51} }
