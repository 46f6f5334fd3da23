scene{ gravity = {0, -9.81}, duration = 0.2 }
local function block(name, x, y)
  return body{ name = name, box{0.6, 0.4}, at = {x, y}, density = 2 } end
revolute{ block('a1', 0, 0), block('a2', 0.7, 0), at = {0.35, 0}, limits = {-1, 1},
  motor = { speed = 2, torque = 3 }, spring = { frequency = 2, damping = 0.3, rest = 0.1 },
  name = 'hinge', break_force = 1e6, break_torque = 1e6, collide = true, hidden = true }
revolute{ 'a1', at = {-0.3, 0} }
prismatic{ world, block('b', 3, 0), axis = {1, 1}, limits = {-0.5, 0.7},
  motor = { speed = -1, force = 2 }, spring = { frequency = 1, damping = 0.1, rest = 0.2 } }
weld{ block('c1', 6, 0), block('c2', 6.6, 0), at = {6.3, 0}, spring = { frequency = 3 } }
weld{ 'c1', world }
wheel{ block('d1', 9, 1), block('d2', 9, 0), axis = {0, 1}, limits = {-0.2, 0.2},
  motor = { speed = 5, torque = 1 }, spring = { frequency = 4, damping = 0.7 } }
distance{ world, block('e1', 12, 0), at_a = {12, 2}, limits = {0, 1.8} }
distance{ 'e1', block('e2', 12, -2), at_a = {12.1, -0.2}, length = 1.5,
  spring = { frequency = 2, damping = 0.2 } }
mouse{ block('f', 15, 0), at = {15.2, 0.1}, target = {16, 1}, max_force = 100,
  spring = { frequency = 3, damping = 0.9 } }
motor{ world, block('g', 18, 0), angle = 0.5, offset = {0.2, 0.3}, max_force = 50,
  max_torque = 20 }
local h1 = revolute{ block('h1', 21, 0), motor = { speed = 3, torque = 100 } }
local h2 = revolute{ block('h2', 22, 0) }
local h3 = prismatic{ block('h3', 22, 2), axis = {1, 0} }
gear{ h1, h2, ratio = -2 }
gear{ h1, h3, ratio = 0.5 }
pulley{ block('i1', 25, 0), block('i2', 27, -1), wheel_a = {25, 3}, wheel_b = {27, 3},
  ratio = 2 }
revolute{ block('j', 30, 0), at = {29.8, 0} }
ratchet{ 'j', pitch = 0.3 }
friction{ block('k', 33, 0), at = {33.1, 0}, max_force = 4, max_torque = 0.3 }
body{ name = 'zone', type = 'static', sensor = true, box{9, 9}, category = 'eye', ignores = {} }
on_break(function(n, e) print(n, e.fx) end)
on_enter{ a = 'zone', function(z, b) print(#z:overlaps()) end }
on_hit{ speed = 0.1, function(a, b, c) exclude(a, b) end }
edit_contact(function(a, b, c) c.friction = 0 end)
