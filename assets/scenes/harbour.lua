-- harbour.lua - a swell runs in from the left; a boat, a raft and a buoy ride it, and a crate falls in between them.
-- Shows: waves that bodies feel and make, drift and slope, a surface that any script may ask for.
scene { title = "Harbour", description = "What floats rides the swell; what falls in makes waves of its own.", duration = 12 }
camera { fit = {{-17, -4.5}, {17, 6.5}}, at = 2.6 }
local quay = material { friction = 0.5, density = 2000 }
body { type = "static", box { 34, 0.5, at = {0, -4.25} }, box { 0.6, 6, at = {-16.7, -1.5} }, box { 0.6, 6, at = {16.7, -1.5} }, material = quay }
local sea = water { name = "sea", box { 32.8, 4 }, at = {0, -2} }
waves { body = sea, modes = 128, swell = 0.22, swell_length = 9 }

local boat = body { name = "boat", polygon { {-1.7, 0.45}, {-1.2, -0.45}, {1.2, -0.45}, {1.7, 0.45} }, density = 300, at = {-8, 0.35}, color = 5 }
local raft = body { name = "raft", box { 4, 0.4 }, density = 400, at = {4.5, 0.1}, color = 2 }
local buoy = body { name = "buoy", circle { 0.45 }, density = 300, at = {12.5, 0.2}, color = 8 }
local crate = body { name = "crate", box { 1.2, 1.2 }, density = 700, at = {-1.5, 6}, angle = 0.5, color = 6 }

-- How far what floats is from where the water is.
local function over(b) local x, y = b:position() return y - wave_at(x) end
local highest = 0
every(1 / 30, function() for x = -16, 16 do highest = math.max(highest, (wave_at(x))) end end)
expect { "the splash stands higher than the swell", at = 12, test = function() return highest > 0.4, highest, 0.4 end }
expect { "the buoy rides with the surface", at = 12, test = function() local d = math.abs(over(buoy)) return d < 0.4, d, 0.4 end }
expect { "the raft stays on top", at = 12, test = function() local d = math.abs(over(raft)) return d < 0.35, d, 0.35 end }
expect { "the boat keeps upright", at = 12, body = "boat", angle = {-0.6, 0.6} }
expect { "the crate floats", at = 12, body = "crate", y = {-1.2, 1.2} }
