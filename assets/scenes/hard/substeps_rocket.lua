-- substeps_rocket.lua - a box of 300 times the mass is dropped a hand's breadth onto a small one, at 16 substeps.
-- Fails: stiffness that grows with substeps stores what the small one cannot hold and throws it: rockets.
-- Right: the small one holds; nothing rises above where it began.
scene { title = "300 : 1, 16 substeps", duration = 4, substeps = 16 }
local ratio = param("ratio", 300, 1, 1e6)
body { type = "static", box { 40, 1 }, at = {0, -0.5} }
body { name = "small", box { 1, 1 }, at = {0, 0.5}, mass = 1 }
body { name = "heavy", box { 1, 1 }, at = {0, 1.6}, mass = ratio }

expect { "nothing takes off", always = true, body = "heavy", y = {0, 1.61} }
expect { "the small one is not thrown", always = true, body = "small", y = {0, 0.52} }
expect { "the small one holds", body = "heavy", x = {-0.01, 0.01}, y = {1.49, 1.501} }
