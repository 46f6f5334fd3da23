scene{ duration = 1 }
body{ name = "post", circle{0.3}, at = {0, 1} }
local r = rope{ from = {-1, 2}, to = {0, 1}, to_body = "post", hold = "from", nodes = 6, break_strain = 0.1, bending = 1 }
cloth{ at = {2, 2}, size = {1, 1}, columns = 2, rows = 2, hold = "top" }
jelly{ box{1, 1, at = {4, 1}}, spacing = 0.5, young = 1e4 }
local b = balloon{ at = {6, 1}, radius = 0.5, nodes = 8, pressure = 100, ambient = 10 }
softbody{ nodes = {{8, 2, 0, 0, 1, 0}, {8, 1, 0, 0, 1, 0}}, edges = {{1, 2, 1, 99, 0, 0, 0, 1}}, pins = {{1, 8, 2}} }
at(0.2, function() r:cut(2) r:set_rest(3, 0.2) r:edge(3) b:set_gas(50) r:release(1) end)
at(0.4, function() r:remove() end)
print(b:measure().pressure) print(r:node(1)) print(r:count())
