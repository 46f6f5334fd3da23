-- smash.lua - a heavy block flies at 40 m/s, without gravity, into a wall of 300 small boxes at rest (Box2D's benchmark Smash). What it
-- loses they get: momentum is kept, energy never grows, and the block is not in them.
-- watchdog: allow sinking: 200 times their mass presses boxes on boxes
scene { title = "Smash", gravity = {0, 0}, duration = 3 }
camera { fit = {{-9, -6}, {22, 6}}, at = 0.45 }
body { name = "block", box { 2, 2 }, at = {-6, 0}, velocity = {40, 0}, density = 8, color = 1 }
for i = 0, 14 do
    for j = 0, 19 do body { name = ("box%d_%d"):format(i, j), box { 0.4, 0.4 }, at = {0.41 * i, 0.41 * (j - 9.5)}, color = 2 } end
end
local e0
every_step(function(t) e0 = e0 or energy() end)
expect { "momentum is kept", always = true, momentum_drift = 1e-3 }
expect { "energy never grows", always = true, test = function()
    local share = energy() / (e0 or energy()) return share <= 1.001, share, 1.001 end }
expect { "the block is slowed", body = "block", vx = {5, 35} }
expect { "nothing is left in anything", from = 2, max_penetration = 0.05 }
