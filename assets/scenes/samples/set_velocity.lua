-- set_velocity.lua - a box that is told each step to move down at 20 m/s stands on the ground and does not sink into it;
-- one that is told to move sideways into a wall stays before it; one that nothing stops moves as told, and falls within each step alone.
scene { title = "Velocity by order", duration = 4 }
camera { fit = {{-6, -1.5}, {7, 5}}, at = 3 }
body { type = "static", box { 40, 0.5, at = {0, -0.25} }, box { 0.5, 4, at = {6, 2} } }
local down = body { name = "down", box { 1, 1 }, at = {-3, 0.5}, color = 1 }
local side = body { name = "side", box { 1, 1 }, at = {3, 0.5}, color = 2 }
local free = body { name = "free", circle { 0.3 }, at = {-5, 3}, color = 3 }
every_step(function()
    down:set_velocity(0, -20)
    side:set_velocity(20, 0)
    free:set_velocity(2, 0)
end)
expect { "it stands on the ground", always = true, body = "down", y = {0.45, 0.51} }
expect { "it stays before the wall", from = 1, body = "side", x = {5.2, 5.3}, y = {0.45, 0.6} }
expect { "the free one moves as told, and falls by g dt^2 / 2 a step", body = "free", x = -5 + 2 * 4,
         y = 3 - 240 * 9.81 / 60 / 60 / 2, tolerance = 0.002 }
