-- billiards.lua - a break on a table of 2.54 m x 1.27 m seen from above: no gravity, balls of 57 mm.
-- Shows: a tight cluster hit at 8 m/s; momentum is kept until the first cushion, energy never grows.
-- lint: allow fast-and-thin: the cue ball meets the pack head on
scene { title = "Billiards break", description = "Fifteen balls and a cue ball, seen from above.",
        gravity = {0, 0}, duration = 4 }
camera { fit = {{-1.4, -0.76}, {1.4, 0.76}} }

local ivory = material { name = "ivory", density = 660, friction = 0.03, restitution = 0.95 }
local rubber = material { name = "rubber", friction = 0.1, restitution = 0.8 }
local w, h, rim, r = 2.54, 1.27, 0.08, 0.0286
body {
    name = "cushions", type = "static", material = rubber, color = "#5d4037",
    box { w + 2 * rim, rim, at = {0, (h + rim) / 2} }, box { w + 2 * rim, rim, at = {0, -(h + rim) / 2} },
    box { rim, h, at = {(w + rim) / 2, 0} }, box { rim, h, at = {-(w + rim) / 2, 0} },
}

local number = 0
for row = 0, 4 do -- a rack with a hair's breadth between the balls
    for i = 0, row do
        number = number + 1
        body {
            name = "ball" .. number, circle { r }, material = ivory, color = number,
            at = {w / 4 + row * (2 * r + 2e-4) * 0.8660254, (i - row / 2) * (2 * r + 2e-4)},
        }
    end
end
body { name = "cue", circle { r }, at = {-w / 4, 0.004}, velocity = {8, 0}, material = ivory, color = "#f5f5f0" }

expect { "momentum is kept before the first cushion", till = 0.15, momentum_drift = 1e-4 }
expect { "all balls stay on the table", always = true, body = "ball*",
         x = {-w / 2, w / 2}, y = {-h / 2, h / 2} }
expect { "no energy appears", always = true, test = function()
    local kinetic = energy()
    local start = 0.5 * 660 * math.pi * r * r * 64
    return kinetic <= start * 1.001, kinetic / start, 1.001
end }
expect { "the rack is broken", at = 2, body = "ball15", speed = {0.05, 8} }
