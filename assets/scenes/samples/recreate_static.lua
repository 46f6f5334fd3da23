-- recreate_static.lua - the ground under a resting box is destroyed and made again each step, in the same place: the box stays
-- where it is, neither falling nor hopping.
scene { title = "Ground made anew", duration = 4 }
camera { fit = {{-5, -1.5}, {5, 3}}, at = 2 }
local ground
local function make()
    if ground then ground:destroy() end
    ground = body { type = "static", box { 8, 1 }, at = {0, -0.5} }
end
make()
every_step(make)
body { name = "crate", box { 1, 1 }, at = {-1, 0.5}, color = 1 }
body { name = "disc", circle { 0.5 }, at = {1.5, 0.5}, color = 2 }
expect { "the crate stays", always = true, body = "crate", x = -1, y = 0.5, angle = {-0.005, 0.005}, tolerance = 0.01 }
expect { "so does the disc", always = true, body = "disc", x = 1.5, y = 0.5, tolerance = 0.01 }
