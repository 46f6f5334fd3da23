scene{ gravity = {0, -1}, duration = 1 }
mutual{ strength = 1, on = "charge", softening = 0.1 }
zone{ electric = {1, 0}, radius = 2 }
local b = body{ name = "bar", box{1, 0.3}, dipole = 2, dipole_angle = 1 }
body{ circle{0.2}, at = {1, 0}, dipole = -1e9, charge = 1e9 }
revolute{ b, world, at = {0, 0} }
at(0.1, function() b:set_dipole(0) b:set_dipole_angle(1e9) end)
