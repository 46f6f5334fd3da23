scene{ duration = 1 }
body{ type = "static", box{6, 1, at = {0, -0.5}} }
body{ circle{0.3}, at = {0, 2}, density = 300 }
liquid{ spacing = 0.1, density = 900, viscosity = 2, color = 3, box{2, 1, at = {0, 0.5}}, velocity = {1, 0} }
liquid{ polygon{ {-1, 2}, {1, 2}, {0, 3} } }
liquid{ particles = { {1, 2}, {1.1, 2, 3, -4}, {1.2, 2, 0, 0, 1, 2, 3, -1} } }
print(liquid_in(-1, 0, 1, 1))
