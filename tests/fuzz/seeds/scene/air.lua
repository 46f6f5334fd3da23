scene{ duration = 1 }
body{ name = "post", type = "static", circle{0.3}, at = {0, 1} }
air{ size = {4, 2}, at = {0, 1}, cell = 0.25, bottom = "closed", left = "flow", flow = {1, 0}, viscosity = 0.01, color = 3, fading = 0.1 }
local s = air_source{ at = {0, 0.2}, radius = 0.3, smoke = 3, heat = 90, push = {1, 0} }
air_source{ body = "post", radius = 0.1, smoke = 1 }
air_fill(function(x, y) return y, nil, x, 3 end)
at(0.2, function() s:set{ heat = 10 } end)
at(0.4, function() s:remove() end)
print(air_at(0, 1)) print(air_sum())
