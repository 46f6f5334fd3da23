// test_scene_joint_errors.c - joints, filters, sensors, materials and their events said wrongly in a
// scene: the exact code and message that each mistake must give.
#include "malformed.h"

// clang-format off
static const malformed table[] = {
    { .what = "joint unknown key",
      .file = "scene.lua",
      .text = "local d = body{ name = 'door', box{1, 1} }\n"
              "revolute{ d, limit = {0, 1} }",
      .code = SCENE_E_KEY,
      .message = "scene.lua:2:14: unknown key 'limit' in revolute{} (did you mean 'limits'?)" },
    { .what = "joint without ends",
      .file = "scene.lua",
      .text = "local d = body{ name = 'door', box{1, 1} }\n"
              "revolute{}",
      .code = SCENE_E_MISSING,
      .message = "scene.lua:2:1: revolute{} needs two bodies, or one and world" },
    { .what = "joint of a body with itself",
      .file = "scene.lua",
      .text = "local d = body{ name = 'door', box{1, 1} }\n"
              "revolute{ d, d }",
      .code = SCENE_E_CONFLICT,
      .message = "scene.lua:2:1: both ends of revolute{} are 'door': a joint holds two different ones" },
    { .what = "joint of an unknown body",
      .file = "scene.lua",
      .text = "local d = body{ name = 'door', box{1, 1} }\n"
              "revolute{ 'doors' }",
      .code = SCENE_E_NAME,
      .message = "scene.lua:2:11: no body is called 'doors' (did you mean 'door'?)" },
    { .what = "joint of a number",
      .file = "scene.lua",
      .text = "local d = body{ name = 'door', box{1, 1} }\n"
              "weld{ 5 }",
      .code = SCENE_E_TYPE,
      .message = "scene.lua:2:7: 'a' of weld{} must be a body, the name of one, or world, not a number" },
    { .what = "joint of three",
      .file = "scene.lua",
      .text = "local d = body{ name = 'door', box{1, 1} }\n"
              "weld{ d, world, d }",
      .code = SCENE_E_KEY,
      .message = "scene.lua:2:17: weld{} takes 2 values by position, not 3" },
    { .what = "joint of what cannot move",
      .file = "scene.lua",
      .text = "local d = body{ name = 'door', box{1, 1} }\n"
              "weld{ body{ type = 'static', box{1, 1} }, world }",
      .code = SCENE_E_CONFLICT,
      .message = "scene.lua:2:1: a weld{} of 'body2' and 'world' does nothing: neither is dynamic" },
    { .what = "joint of a dead body",
      .file = "scene.lua",
      .text = "local d = body{ name = 'door', box{1, 1} }\n"
              "d:destroy()\n"
              "weld{ d }",
      .code = SCENE_E_STATE,
      .message = "scene.lua:3:7: 'a' of weld{} is a body that was destroyed" },
    { .what = "joint with arguments",
      .file = "scene.lua",
      .text = "local d = body{ name = 'door', box{1, 1} }\n"
              "weld(d, world)",
      .code = SCENE_E_TYPE,
      .message = "scene.lua:2:1: weld takes one table: weld{...}" },
    { .what = "limits the wrong way round",
      .file = "scene.lua",
      .text = "local d = body{ name = 'door', box{1, 1} }\n"
              "revolute{ d, limits = {1, 0} }",
      .code = SCENE_E_RANGE,
      .message = "scene.lua:2:14: 'limits' of revolute{} is empty: lower 1 is above upper 0" },
    { .what = "limits of one number",
      .file = "scene.lua",
      .text = "local d = body{ name = 'door', box{1, 1} }\n"
              "revolute{ d, limits = 1 }",
      .code = SCENE_E_TYPE,
      .message = "scene.lua:2:14: 'limits' of revolute{} must be two numbers {lower, upper}, not a number" },
    { .what = "limits of a rope below zero",
      .file = "scene.lua",
      .text = "local d = body{ name = 'door', box{1, 1} }\n"
              "distance{ d, world, at_b = {0, 3}, limits = {-1, 2} }",
      .code = SCENE_E_RANGE,
      .message = "scene.lua:2:36: 'limits' of distance{} must be at least 0 and at most 1e+12 m, not -1" },
    { .what = "motor that is no table",
      .file = "scene.lua",
      .text = "local d = body{ name = 'door', box{1, 1} }\n"
              "revolute{ d, motor = 3 }",
      .code = SCENE_E_TYPE,
      .message = "scene.lua:2:14: 'motor' of revolute{} must be a table {...}, not a number" },
    { .what = "motor's unknown key on its own line",
      .file = "scene.lua",
      .text = "local d = body{ name = 'door', box{1, 1} }\n"
              "revolute{ d, motor = { speed = 1,\n"
              "  torqe = 3 } }",
      .code = SCENE_E_KEY,
      .message = "scene.lua:3:3: unknown key 'torqe' in motor{} (did you mean 'torque'?)" },
    { .what = "motor without speed",
      .file = "scene.lua",
      .text = "local d = body{ name = 'door', box{1, 1} }\n"
              "revolute{ d, motor = { torque = 1 } }",
      .code = SCENE_E_MISSING,
      .message = "scene.lua:2:14: motor{} needs 'speed'" },
    { .what = "motor without torque",
      .file = "scene.lua",
      .text = "local d = body{ name = 'door', box{1, 1} }\n"
              "wheel{ d, motor = { speed = 1 } }",
      .code = SCENE_E_MISSING,
      .message = "scene.lua:2:11: the motor of a wheel{} needs 'torque'" },
    { .what = "slider's motor with torque",
      .file = "scene.lua",
      .text = "local d = body{ name = 'door', box{1, 1} }\n"
              "prismatic{ d, motor = { speed = 1, torque = 2 } }",
      .code = SCENE_E_KEY,
      .message = "scene.lua:2:36: the motor of a prismatic{} has no 'torque' (did you mean 'force'?)" },
    { .what = "motor for a weld",
      .file = "scene.lua",
      .text = "local d = body{ name = 'door', box{1, 1} }\n"
              "weld{ d, motor = { speed = 1, torque = 2 } }",
      .code = SCENE_E_KEY,
      .message = "scene.lua:2:10: unknown key 'motor' in weld{}; it belongs to revolute{}, prismatic{} or wheel{}" },
    { .what = "spring's range",
      .file = "scene.lua",
      .text = "local d = body{ name = 'door', box{1, 1} }\n"
              "wheel{ d, spring = { frequency = -1 } }",
      .code = SCENE_E_RANGE,
      .message = "scene.lua:2:22: 'frequency' of spring{} must be above 0 and at most 1000000 1/s, not -1" },
    { .what = "spring without frequency",
      .file = "scene.lua",
      .text = "local d = body{ name = 'door', box{1, 1} }\n"
              "wheel{ d, spring = { damping = 1 } }",
      .code = SCENE_E_MISSING,
      .message = "scene.lua:2:11: the spring of a wheel{} needs 'frequency', or 'stiffness' or 'damper' above 0" },
    { .what = "spring told twice",
      .file = "scene.lua",
      .text = "local d = body{ name = 'door', box{1, 1} }\n"
              "wheel{ d, spring = { frequency = 1, stiffness = 2 } }",
      .code = SCENE_E_CONFLICT,
      .message = "scene.lua:2:11: the spring of a wheel{} has either 'frequency' and 'damping', or 'stiffness' and 'damper'" },
    { .what = "stiffness below 0",
      .file = "scene.lua",
      .text = "local d = body{ name = 'door', box{1, 1} }\n"
              "wheel{ d, spring = { stiffness = -2 } }",
      .code = SCENE_E_RANGE,
      .message = "scene.lua:2:22: 'stiffness' of spring{} must be at least 0 and at most 1e+12 N/m or N m/rad, not -2" },
    { .what = "rest of a distance",
      .file = "scene.lua",
      .text = "local d = body{ name = 'door', box{1, 1} }\n"
              "distance{ d, world, at_b = {0, 3}, spring = { frequency = 1, rest = 2 } }",
      .code = SCENE_E_KEY,
      .message = "scene.lua:2:62: the spring of a distance{} has no 'rest': give the joint's 'length'" },
    { .what = "rest of a motor joint",
      .file = "scene.lua",
      .text = "local d = body{ name = 'door', box{1, 1} }\n"
              "motor{ d, spring = { frequency = 1, rest = 2 } }",
      .code = SCENE_E_KEY,
      .message = "scene.lua:2:37: the spring of a motor{} has no 'rest': give the joint's 'angle'" },
    { .what = "rod without length",
      .file = "scene.lua",
      .text = "local d = body{ name = 'door', box{1, 1} }\n"
              "distance{ d, world, at_b = {0, 0} }",
      .code = SCENE_E_GEOMETRY,
      .message = "scene.lua:2:1: distance{}: length is 0; a rod must have length (use a revolute joint)" },
    { .what = "distance tied nowhere",
      .file = "scene.lua",
      .text = "local d = body{ name = 'door', box{1, 1} }\n"
              "distance{ d, world }",
      .code = SCENE_E_MISSING,
      .message = "scene.lua:2:1: distance{} needs 'at_b': where on the world it is tied" },
    { .what = "pulley without wheels",
      .file = "scene.lua",
      .text = "local d = body{ name = 'door', box{1, 1} }\n"
              "pulley{ d, body{ box{1, 1} } }",
      .code = SCENE_E_MISSING,
      .message = "scene.lua:2:1: pulley{} needs 'wheel_a'" },
    { .what = "pulley of one",
      .file = "scene.lua",
      .text = "local d = body{ name = 'door', box{1, 1} }\n"
              "pulley{ d, wheel_a = {0, 1}, wheel_b = {1, 1} }",
      .code = SCENE_E_MISSING,
      .message = "scene.lua:2:1: pulley{} needs two bodies" },
    { .what = "gear of one",
      .file = "scene.lua",
      .text = "local d = body{ name = 'door', box{1, 1} }\n"
              "gear{ d }",
      .code = SCENE_E_MISSING,
      .message = "scene.lua:2:1: gear{} needs two bodies" },
    { .what = "gear ratio of zero",
      .file = "scene.lua",
      .text = "local d = body{ name = 'door', box{1, 1} }\n"
              "gear{ d, body{ box{1, 1} }, ratio = 0 }",
      .code = SCENE_E_RANGE,
      .message = "scene.lua:2:29: 'ratio' of gear{} must not be 0" },
    { .what = "gear of a joint and its body",
      .file = "scene.lua",
      .text = "local d = body{ name = 'door', box{1, 1} }\n"
              "gear{ d, revolute{ d }, ratio = 2 }",
      .code = SCENE_E_CONFLICT,
      .message = "scene.lua:2:1: both ends of gear{} are 'door': a joint holds two different ones" },
    { .what = "ratchet without teeth",
      .file = "scene.lua",
      .text = "local d = body{ name = 'door', box{1, 1} }\n"
              "ratchet{ d }",
      .code = SCENE_E_MISSING,
      .message = "scene.lua:2:1: ratchet{} needs 'pitch'" },
    { .what = "ratchet of pitch zero",
      .file = "scene.lua",
      .text = "local d = body{ name = 'door', box{1, 1} }\n"
              "ratchet{ d, pitch = 0 }",
      .code = SCENE_E_RANGE,
      .message = "scene.lua:2:13: 'pitch' of ratchet{} must not be 0" },
    { .what = "break force of zero",
      .file = "scene.lua",
      .text = "local d = body{ name = 'door', box{1, 1} }\n"
              "weld{ d, break_force = 0 }",
      .code = SCENE_E_RANGE,
      .message = "scene.lua:2:10: 'break_force' of weld{} must be above 0 and at most 1e+12 N, not 0" },
    { .what = "joints of one name",
      .file = "scene.lua",
      .text = "local d = body{ name = 'door', box{1, 1} }\n"
              "weld{ d, name = 'j' }\n"
              "revolute{ d, name = 'j' }",
      .code = SCENE_E_DUPLICATE,
      .message = "scene.lua:3:14: two joints are called 'j'" },
    { .what = "star in a joint's name",
      .file = "scene.lua",
      .text = "local d = body{ name = 'door', box{1, 1} }\n"
              "weld{ d, name = 'j*' }",
      .code = SCENE_E_RANGE,
      .message = "scene.lua:2:10: 'name' of weld{} must not contain '*': it stands for any ending elsewhere" },
    { .what = "hinge",
      .file = "scene.lua",
      .text = "local d = body{ name = 'door', box{1, 1} }\n"
              "hinge{ d }",
      .code = SCENE_E_NAME,
      .message = "scene.lua:2:1: unknown name 'hinge' (did you mean 'revolute'?)" },
    { .what = "rod",
      .file = "scene.lua",
      .text = "local d = body{ name = 'door', box{1, 1} }\n"
              "rod{ d, world }",
      .code = SCENE_E_NAME,
      .message = "scene.lua:2:1: unknown name 'rod' (did you mean 'distance'?)" },
    { .what = "joint's unknown method",
      .file = "scene.lua",
      .text = "local d = body{ name = 'door', box{1, 1} }\n"
              "local j = revolute{ d }\n"
              "j:set_motr(1)",
      .code = SCENE_E_NAME,
      .message = "scene.lua:3:3: a joint has no 'set_motr' (did you mean 'set_motor'?)" },
    { .what = "joint's method without colon",
      .file = "scene.lua",
      .text = "local d = body{ name = 'door', box{1, 1} }\n"
              "local j = revolute{ d }\n"
              "print(j.angle())",
      .code = SCENE_E_TYPE,
      .message = "scene.lua:3:9: angle is a method: write joint:angle(...)" },
    { .what = "joint assigned",
      .file = "scene.lua",
      .text = "local d = body{ name = 'door', box{1, 1} }\n"
              "local j = revolute{ d }\n"
              "j.angle = 2",
      .code = SCENE_E_STATE,
      .message = "scene.lua:3:3: a joint's 'angle' cannot be assigned: call a method" },
    { .what = "dead joint",
      .file = "scene.lua",
      .text = "local d = body{ name = 'door', box{1, 1} }\n"
              "local j = revolute{ d }\n"
              "j:destroy()\n"
              "print(j:angle())",
      .code = SCENE_E_STATE,
      .message = "scene.lua:4:9: angle() of a joint that is gone" },
    { .what = "joint that went with its body",
      .file = "scene.lua",
      .text = "local d = body{ name = 'door', box{1, 1} }\n"
              "local j = revolute{ d }\n"
              "d:destroy()\n"
              "print(j:angle())",
      .code = SCENE_E_STATE,
      .message = "scene.lua:4:9: angle() of a joint that is gone" },
    { .what = "angle of a rod",
      .file = "scene.lua",
      .text = "local d = body{ name = 'door', box{1, 1} }\n"
              "local j = distance{ d, world, at_b = {0, 3} }\n"
              "print(j:angle())",
      .code = SCENE_E_STATE,
      .message = "scene.lua:3:9: angle() of 'joint1': a distance joint has no angle: see value()" },
    { .what = "motor of a weld set",
      .file = "scene.lua",
      .text = "local d = body{ name = 'door', box{1, 1} }\n"
              "local j = weld{ d }\n"
              "j:set_motor(1, 2)",
      .code = SCENE_E_STATE,
      .message = "scene.lua:3:3: set_motor() of 'joint1': a weld joint has no motor" },
    { .what = "motor speed without motor",
      .file = "scene.lua",
      .text = "local d = body{ name = 'door', box{1, 1} }\n"
              "local j = revolute{ d }\n"
              "j:set_motor_speed(1)",
      .code = SCENE_E_STATE,
      .message = "scene.lua:3:3: set_motor_speed() of 'joint1': a revolute joint has no motor that is on: call set_motor(speed, torque or force)" },
    { .what = "limits set the wrong way round",
      .file = "scene.lua",
      .text = "local d = body{ name = 'door', box{1, 1} }\n"
              "local j = revolute{ d }\n"
              "j:set_limits(1, 0)",
      .code = SCENE_E_RANGE,
      .message = "scene.lua:3:3: set_limits() of 'joint1': upper is 0; it must be at least 1" },
    { .what = "break set below zero",
      .file = "scene.lua",
      .text = "local d = body{ name = 'door', box{1, 1} }\n"
              "local j = revolute{ d }\n"
              "j:set_break(-1)",
      .code = SCENE_E_RANGE,
      .message = "scene.lua:3:3: set_break() of 'joint1': force is -1; it must be at least 0" },
    { .what = "on_break unknown joint",
      .file = "scene.lua",
      .text = "local d = body{ name = 'door', box{1, 1} }\n"
              "revolute{ d, name = 'pin' }\n"
              "on_break{ joint = 'pun', function() end }",
      .code = SCENE_E_NAME,
      .message = "scene.lua:3:11: no joint is called 'pun' (did you mean 'pin'?)" },
    { .what = "on_break without function",
      .file = "scene.lua",
      .text = "local d = body{ name = 'door', box{1, 1} }\n"
              "on_break{ joint = 'pin' }",
      .code = SCENE_E_MISSING,
      .message = "scene.lua:2:1: on_break{} needs a function" },
    { .what = "on_break of a body",
      .file = "scene.lua",
      .text = "local d = body{ name = 'door', box{1, 1} }\n"
              "on_break{ joint = d, function() end }",
      .code = SCENE_E_TYPE,
      .message = "scene.lua:2:11: 'joint' of on_break{} must be a joint or the name of one, not a body" },
    { .what = "on_hit speed",
      .file = "scene.lua",
      .text = "local d = body{ name = 'door', box{1, 1} }\n"
              "on_hit{ speed = 0, function() end }",
      .code = SCENE_E_RANGE,
      .message = "scene.lua:2:9: 'speed' of on_hit{} must be above 0 and at most 1000000 m/s, not 0" },
    { .what = "on_enter b alone",
      .file = "scene.lua",
      .text = "local d = body{ name = 'door', box{1, 1} }\n"
              "on_enter{ b = 'door', function() end }",
      .code = SCENE_E_MISSING,
      .message = "scene.lua:2:11: on_enter{} with 'b' needs 'a'" },
    { .what = "edit_contact misused",
      .file = "scene.lua",
      .text = "local d = body{ name = 'door', box{1, 1} }\n"
              "edit_contact(5)",
      .code = SCENE_E_TYPE,
      .message = "scene.lua:2:1: edit_contact takes a function or a table: edit_contact{a = ..., b = ..., function}" },
    { .what = "expect unknown joint",
      .file = "scene.lua",
      .text = "local d = body{ name = 'door', box{1, 1} }\n"
              "revolute{ d, name = 'pin' }\n"
              "expect{ 'x', joint = 'pen', joint_value = 1 }",
      .code = SCENE_E_NAME,
      .message = "scene.lua:3:14: no joint is called 'pen' (did you mean 'pin'?)" },
    { .what = "expect joint_value of whom",
      .file = "scene.lua",
      .text = "local d = body{ name = 'door', box{1, 1} }\n"
              "expect{ 'x', joint_value = 1 }",
      .code = SCENE_E_MISSING,
      .message = "scene.lua:2:1: expect{} needs 'joint' to know whose value or reaction is meant" },
    { .what = "expect visits of whom",
      .file = "scene.lua",
      .text = "local d = body{ name = 'door', box{1, 1} }\n"
              "expect{ 'x', visits = 1 }",
      .code = SCENE_E_MISSING,
      .message = "scene.lua:2:1: expect{} needs 'body' to know whose sensors are meant" },
    { .what = "expect joint for nothing",
      .file = "scene.lua",
      .text = "local d = body{ name = 'door', box{1, 1} }\n"
              "revolute{ d, name = 'pin' }\n"
              "expect{ 'x', joint = 'pin', max_speed = 1 }",
      .code = SCENE_E_UNUSED,
      .message = "scene.lua:3:14: 'joint' of expect{} is not used" },
    { .what = "mask of nothing that is",
      .file = "scene.lua",
      .text = "local d = body{ name = 'door', box{1, 1} }\n"
              "body{ box{1, 1}, category = 'ball' }\n"
              "body{ box{1, 1}, collides = {'bal'} }",
      .code = SCENE_E_NAME,
      .message = "scene.lua:3:18: no shape is of category 'bal' (did you mean 'ball'?)" },
    { .what = "mask of nothing like it",
      .file = "scene.lua",
      .text = "local d = body{ name = 'door', box{1, 1} }\n"
              "body{ box{1, 1}, ignores = 'stars' }",
      .code = SCENE_E_NAME,
      .message = "scene.lua:2:18: no shape is of category 'stars'" },
    { .what = "misspelt category in spite of handlers",
      .file = "scene.lua",
      .text = "local d = body{ name = 'door', box{1, 1} }\n"
              "body{ box{1, 1}, category = 'ball' }\n"
              "body{ box{1, 1, collides = 'bal'} }\n"
              "every_step(function() end)",
      .code = SCENE_E_NAME,
      .message = "scene.lua:3:17: no shape is of category 'bal' (did you mean 'ball'?)" },
    { .what = "category that is no name",
      .file = "scene.lua",
      .text = "local d = body{ name = 'door', box{1, 1} }\n"
              "body{ box{1, 1}, category = {1} }",
      .code = SCENE_E_TYPE,
      .message = "scene.lua:2:18: 'category' of body{} must be a name or a list of names; value 1 is a number" },
    { .what = "category of none",
      .file = "scene.lua",
      .text = "local d = body{ name = 'door', box{1, 1} }\n"
              "body{ box{1, 1}, category = {} }",
      .code = SCENE_E_RANGE,
      .message = "scene.lua:2:18: 'category' of body{} must name at least one" },
    { .what = "collides and ignores",
      .file = "scene.lua",
      .text = "local d = body{ name = 'door', box{1, 1} }\n"
              "body{ box{1, 1}, collides = 'default', ignores = 'default' }",
      .code = SCENE_E_CONFLICT,
      .message = "scene.lua:2:40: body{} takes either 'collides' or 'ignores'" },
    { .what = "apart and together",
      .file = "scene.lua",
      .text = "local d = body{ name = 'door', box{1, 1} }\n"
              "body{ box{1, 1, apart = 'a', together = 'b'} }",
      .code = SCENE_E_CONFLICT,
      .message = "scene.lua:2:30: box{} takes either 'apart' or 'together'" },
    { .what = "group",
      .file = "scene.lua",
      .text = "local d = body{ name = 'door', box{1, 1} }\n"
              "body{ box{1, 1}, group = 3 }",
      .code = SCENE_E_KEY,
      .message = "scene.lua:2:18: unknown key 'group' in body{} (did you mean 'apart'?)" },
    { .what = "sensor is a boolean",
      .file = "scene.lua",
      .text = "local d = body{ name = 'door', box{1, 1} }\n"
              "body{ box{1, 1}, sensor = 1 }",
      .code = SCENE_E_TYPE,
      .message = "scene.lua:2:18: 'sensor' of body{} must be true or false, not a number" },
    { .what = "nothing but sensors",
      .file = "scene.lua",
      .text = "local d = body{ name = 'door', box{1, 1} }\n"
              "body{ box{1, 1, sensor = true} }",
      .code = SCENE_E_MISSING,
      .message = "scene.lua:2:1: a dynamic body{} of nothing but sensors needs 'mass'" },
    { .what = "body called world",
      .file = "scene.lua",
      .text = "local d = body{ name = 'door', box{1, 1} }\n"
              "body{ name = 'world', box{1, 1} }",
      .code = SCENE_E_RANGE,
      .message = "scene.lua:2:7: 'name' of body{} must not be 'world': that is what joints hold on to" },
    { .what = "excluded with itself",
      .file = "scene.lua",
      .text = "local d = body{ name = 'door', box{1, 1} }\n"
              "exclude(d, d)",
      .code = SCENE_E_CONFLICT,
      .message = "scene.lua:2:12: exclude() of a body with itself" },
    { .what = "exclude one",
      .file = "scene.lua",
      .text = "local d = body{ name = 'door', box{1, 1} }\n"
              "exclude(d)",
      .code = SCENE_E_TYPE,
      .message = "scene.lua:2:1: exclude takes two bodies and perhaps false: exclude(a, b)" },
    { .what = "exclude unknown",
      .file = "scene.lua",
      .text = "local d = body{ name = 'door', box{1, 1} }\n"
              "exclude(d, 'doors')",
      .code = SCENE_E_NAME,
      .message = "scene.lua:2:1: no body is called 'doors' (did you mean 'door'?)" },
    { .what = "exclude a number",
      .file = "scene.lua",
      .text = "local d = body{ name = 'door', box{1, 1} }\n"
              "exclude(d, 3)",
      .code = SCENE_E_TYPE,
      .message = "scene.lua:2:12: exclude takes two bodies, or their names, not a number" },
    { .what = "overlaps without sensor",
      .file = "scene.lua",
      .text = "local d = body{ name = 'door', box{1, 1} }\n"
              "print(d:overlaps())",
      .code = SCENE_E_STATE,
      .message = "scene.lua:2:9: overlaps() of 'door': it has no sensor" },
    { .what = "set_filter key",
      .file = "scene.lua",
      .text = "local d = body{ name = 'door', box{1, 1} }\n"
              "d:set_filter{ colides = {} }",
      .code = SCENE_E_KEY,
      .message = "scene.lua:2:15: unknown key 'colides' in set_filter{} (did you mean 'collides'?)" },
    { .what = "mix rule",
      .file = "scene.lua",
      .text = "local d = body{ name = 'door', box{1, 1} }\n"
              "local m = material{ friction_mix = 'mean' }\n"
              "body{ box{1, 1}, material = m }",
      .code = SCENE_E_RANGE,
      .message = "scene.lua:2:21: 'friction_mix' of material{} must be one of default|average|geometric|multiply|min|max, not 'mean'" },
    { .what = "rolling resistance negative",
      .file = "scene.lua",
      .text = "local d = body{ name = 'door', box{1, 1} }\n"
              "local m = material{ rolling_resistance = -1 }\n"
              "body{ box{1, 1}, material = m }",
      .code = SCENE_E_RANGE,
      .message = "scene.lua:2:21: 'rolling_resistance' of material{} must be at least 0 and at most 1e+12 m, not -1" },
    { .what = "pair of no materials",
      .file = "scene.lua",
      .text = "local d = body{ name = 'door', box{1, 1} }\n"
              "material_pair{ material{}, 3, friction = 1 }",
      .code = SCENE_E_TYPE,
      .message = "scene.lua:2:28: 'b' of material_pair{} must be a material, not a number" },
    { .what = "pair without friction",
      .file = "scene.lua",
      .text = "local d = body{ name = 'door', box{1, 1} }\n"
              "local m = material{}\n"
              "body{ box{1, 1}, material = m }\n"
              "material_pair{ m, m }",
      .code = SCENE_E_MISSING,
      .message = "scene.lua:4:1: material_pair{} needs 'friction'" },
    { .what = "pair twice",
      .file = "scene.lua",
      .text = "local d = body{ name = 'door', box{1, 1} }\n"
              "local m = material{ name = 'ice' }\n"
              "body{ box{1, 1}, material = m }\n"
              "material_pair{ m, m, friction = 0 }\n"
              "material_pair{ m, m, friction = 0 }",
      .code = SCENE_E_DUPLICATE,
      .message = "scene.lua:5:1: there is a material_pair{} of 'ice' and 'ice' already" },
    { .what = "material of a pair alone",
      .file = "scene.lua",
      .text = "local d = body{ name = 'door', box{1, 1} }\n"
              "local m = material{}\n"
              "material_pair{ m, m, friction = 0 }",
      .code = SCENE_E_UNUSED,
      .message = "scene.lua:2:11: this material{} is never used: give it to a body{} or a shape" },
    { .what = "material renamed",
      .file = "scene.lua",
      .text = "local d = body{ name = 'door', box{1, 1} }\n"
              "local m = material{}\n"
              "body{ box{1, 1}, material = m }\n"
              "m:set{ name = 'x' }",
      .code = SCENE_E_STATE,
      .message = "scene.lua:4:8: a material keeps its name" },
    { .what = "material's method",
      .file = "scene.lua",
      .text = "local d = body{ name = 'door', box{1, 1} }\n"
              "local m = material{}\n"
              "body{ box{1, 1}, material = m }\n"
              "m:sett{}",
      .code = SCENE_E_NAME,
      .message = "scene.lua:4:3: a material has no 'sett' (did you mean 'set'?)" },
    { .what = "json joint kind",
      .file = "scene.json",
      .text = "{\"format\":\"plumb-scene-1\", \"bodies\":[{\"name\":\"door\",\"shapes\":[{\"kind\":\"circle\",\"r\":1}]}],\n"
              " \"joints\":[{\"kind\":\"revolut\",\"b\":\"door\"}]}",
      .code = SCENE_E_NAME,
      .message = "scene.json:2:13: unknown kind of joint 'revolut' (did you mean 'revolute'?)" },
    { .what = "json joint without kind",
      .file = "scene.json",
      .text = "{\"format\":\"plumb-scene-1\", \"bodies\":[{\"name\":\"door\",\"shapes\":[{\"kind\":\"circle\",\"r\":1}]}],\n"
              " \"joints\":[{\"b\":\"door\"}]}",
      .code = SCENE_E_MISSING,
      .message = "scene.json:2:12: a joint needs 'kind', such as \"revolute\"" },
    { .what = "json joint of an unknown body",
      .file = "scene.json",
      .text = "{\"format\":\"plumb-scene-1\", \"bodies\":[{\"name\":\"door\",\"shapes\":[{\"kind\":\"circle\",\"r\":1}]}],\n"
              " \"joints\":[{\"kind\":\"revolute\",\"b\":\"doer\"}]}",
      .code = SCENE_E_NAME,
      .message = "scene.json:2:31: no body is called 'doer' (did you mean 'door'?)" },
    { .what = "json motor key",
      .file = "scene.json",
      .text = "{\"format\":\"plumb-scene-1\", \"bodies\":[{\"name\":\"door\",\"shapes\":[{\"kind\":\"circle\",\"r\":1}]}],\n"
              " \"joints\":[{\"kind\":\"revolute\",\"b\":\"door\",\"motor\":{\"speed\":1,\"torqu\":2}}]}",
      .code = SCENE_E_KEY,
      .message = "scene.json:2:61: unknown key 'torqu' in motor{} (did you mean 'torque'?)" },
    { .what = "json state lacks",
      .file = "scene.json",
      .text = "{\"format\":\"plumb-scene-1\", \"bodies\":[{\"name\":\"door\",\"shapes\":[{\"kind\":\"circle\",\"r\":1}]}],\n"
              " \"joints\":[{\"kind\":\"revolute\",\"b\":\"door\",\"state\":{\"axis\":[0,0]}}]}",
      .code = SCENE_E_MISSING,
      .message = "scene.json:2:50: state{} needs 'anchor_a'" },
    { .what = "json joints no list",
      .file = "scene.json",
      .text = "{\"format\":\"plumb-scene-1\", \"bodies\":[{\"name\":\"door\",\"shapes\":[{\"kind\":\"circle\",\"r\":1}]}],\n"
              " \"joints\":{}}",
      .code = SCENE_E_TYPE,
      .message = "scene.json:2:2: 'joints' must be an array [...]" },
    { .what = "json excluded",
      .file = "scene.json",
      .text = "{\"format\":\"plumb-scene-1\", \"bodies\":[{\"name\":\"door\",\"shapes\":[{\"kind\":\"circle\",\"r\":1}]}],\n"
              " \"excluded\":[[\"door\"]]}",
      .code = SCENE_E_TYPE,
      .message = "scene.json:2:14: an excluded pair must be the names of two bodies" },
    { .what = "json excluded unknown",
      .file = "scene.json",
      .text = "{\"format\":\"plumb-scene-1\", \"bodies\":[{\"name\":\"door\",\"shapes\":[{\"kind\":\"circle\",\"r\":1}]}],\n"
              " \"excluded\":[[\"door\",\"doer\"]]}",
      .code = SCENE_E_NAME,
      .message = "scene.json:2:14: no body is called 'doer' (did you mean 'door'?)" },
    { .what = "json pair",
      .file = "scene.json",
      .text = "{\"format\":\"plumb-scene-1\", \"bodies\":[{\"name\":\"door\",\"shapes\":[{\"kind\":\"circle\",\"r\":1}]}],\n"
              " \"pairs\":[{\"a\":\"ice\",\"b\":\"ice\",\"friction\":0}]}",
      .code = SCENE_E_NAME,
      .message = "scene.json:2:12: no material is called 'ice'" },
};
// clang-format on

static void test_malformed_scenes(void **state)
{
    (void)state;
    check_malformed(table, (int)(sizeof table / sizeof *table));
}

int main(void)
{
    const struct CMUnitTest tests[] = { cmocka_unit_test(test_malformed_scenes) };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
