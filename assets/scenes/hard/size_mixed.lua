-- size_mixed.lua - pebbles of 2 cm on a block of 20 m, the block on three pebbles of 40 cm; 0.2 m on 200 m of ground
-- (Jolt: BigVsSmall). Fails: tolerances taken from the larger. Right: all lie as if each were alone.
scene { title = "Large and small", duration = 4 }
body { type = "static", box { 200, 100 }, at = {0, -50} }
for i = -1, 1 do body { name = "foot" .. i + 2, box { 0.4, 0.4 }, at = {i * 8, 0.2}, density = 3000 } end
body { name = "block", box { 20, 4 }, at = {0, 2.4}, density = 500 }
for i = 1, 10 do body { name = "pebble" .. i, circle { 0.01 }, at = {i - 5, 4.41} } end
for i = 1, 10 do body { name = "grain" .. i, box { 0.02, 0.02 }, at = {20 + i, 0.01} } end
expect { "pebbles lie on the block", body = "pebble*", y = {4.3, 4.411} }
expect { "no pebble rolls away", body = "pebble*", x = {-4.1, 5.1} }
expect { "the block does not sink", body = "block", y = {2.39, 2.401}, angle = {-1e-3, 1e-3} }
expect { "grains lie on the ground", always = true, body = "grain*", y = {0.0098, 0.0102} }
