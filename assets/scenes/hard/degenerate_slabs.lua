-- degenerate_slabs.lua - plates of 2 m by 5 mm stacked to 20, and a plate that lies over a knife's edge, balanced.
-- Fails: the wrong axis of a thin plate: pushed out sideways. Right: the pile lies; the balanced plate stays level.
-- lint: allow size: thin things are what it asks
scene { title = "Slabs", duration = 6, sleep = false }
local n, thick = param("n", 20, 1, 60), param("thick", 0.005, 5e-4, 0.1)
local steel = material { density = 7800, friction = 0.4 }
body { type = "static", box { 20, 1, at = {0, -0.5} }, polygon {{5.9, 0}, {6.1, 0}, {6, 1}}, material = steel }
for i = 1, n do body { name = "slab" .. i, box { 2, thick }, at = {0, (i - 0.5) * thick}, material = steel } end
body { name = "beam", box { 2, 0.02 }, at = {6, 1.01}, material = steel }
expect { "the pile lies", always = true, body = "slab*", x = {-0.01, 0.01}, y = {0, n * thick + 0.001}, angle = {-0.01, 0.01} }
expect { "the top is on top", body = "slab" .. n, y = {(n - 0.5) * thick * 0.95, (n - 0.4) * thick} }
expect { "the balanced plate stays", always = true, body = "beam", position = {6, 1.01}, tolerance = 0.005 }
