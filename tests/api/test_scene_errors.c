// test_scene_errors.c - malformed scenes, each with the exact code and message that it must give:
// file, line, column, what was expected, and the word that was probably meant.
// Every scene is loaded with small limits, so that those of them that never end do so soon. After
// each, the same loader must still load a good scene: nothing is kept from one scene to the next.
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>
#include <cmocka.h>

#include "scene/scene.h"

/// One malformed scene.
typedef struct malformed {
    const char *what; ///< for the reader of a failure
    const char *file; ///< name given to the text; its ending tells Lua from JSON
    const char *text;
    scene_code code;
    const char *message; ///< scene_error.text
    const char *set;     ///< a --set, or null
} malformed;

// clang-format off
static const malformed table[] = {
    { .what = "unknown key of scene",
      .file = "scene.lua",
      .text = "scene{ gravty = {0, -1} }\n"
              "body{ box{1, 1} }\n",
      .code = SCENE_E_KEY,
      .message = "scene.lua:1:8: unknown key 'gravty' in scene{} (did you mean 'gravity'?)" },
    { .what = "lock of an axis that is none",
      .file = "scene.lua",
      .text = "body{ box{1, 1}, lock = {\"z\"} }",
      .code = SCENE_E_TYPE,
      .message = "scene.lua:1:18: 'lock' of body{} must be a list of \"x\", \"y\", \"rotation\", "
                 "each once" },
    { .what = "damping of a static body",
      .file = "scene.lua",
      .text = "body{ box{1, 1}, type = \"static\", damping = 1 }",
      .code = SCENE_E_CONFLICT,
      .message = "scene.lua:1:35: a static body{} cannot have 'damping'" },
    { .what = "velocity along a locked axis",
      .file = "scene.lua",
      .text = "body{ box{1, 1}, lock = {\"x\"}, velocity = {1, 0} }",
      .code = SCENE_E_CONFLICT,
      .message = "scene.lua:1:32: 'velocity' of body{} must be 0 along x, which is locked" },
    { .what = "spin of a body that cannot turn",
      .file = "scene.lua",
      .text = "body{ box{1, 1}, lock = {\"rotation\"}, spin = 2 }",
      .code = SCENE_E_CONFLICT,
      .message = "scene.lua:1:39: 'spin' of body{} must be 0: its rotation is locked" },
    { .what = "time scale out of range",
      .file = "scene.lua",
      .text = "body{ box{1, 1}, time_scale = 200 }",
      .code = SCENE_E_RANGE,
      .message = "scene.lua:1:18: 'time_scale' of body{} must be at least 0 and at most 100, not 200" },
    { .what = "blast without a radius",
      .file = "scene.lua",
      .text = "body{ box{1, 1} }\nblast{ at = {0, 0}, impulse = 1 }",
      .code = SCENE_E_MISSING,
      .message = "scene.lua:2:1: blast{} needs 'radius'" },
    { .what = "blast with an unknown key",
      .file = "scene.lua",
      .text = "blast{ at = {0, 0}, impulse = 1, radus = 2 }",
      .code = SCENE_E_KEY,
      .message = "scene.lua:1:34: unknown key 'radus' in blast{} (did you mean 'radius'?)" },
    { .what = "blast that reaches nothing",
      .file = "scene.lua",
      .text = "blast{ at = {0, 0}, impulse = 1, radius = 0 }",
      .code = SCENE_E_RANGE,
      .message = "scene.lua:1:1: blast{}: plumb_world_explode: radius + falloff is 0; it must be above "
                 "0 and at most 1e+07" },
    { .what = "blast that ignores nobody",
      .file = "scene.lua",
      .text = "body{ name = \"bomb\", box{1, 1} }\n"
              "blast{ at = {0, 0}, impulse = 1, radius = 1, ignore = \"bmob\" }",
      .code = SCENE_E_NAME,
      .message = "scene.lua:2:46: no body is called 'bmob' (did you mean 'bomb'?)" },
    { .what = "unknown type in set_type",
      .file = "scene.lua",
      .text = "local b = body{ box{1, 1} }\nb:set_type(\"statc\")",
      .code = SCENE_E_RUNTIME,
      .message = "scene.lua:2:3: bad argument #1 to 'set_type' (invalid option 'statc')" },
    { .what = "unknown key of material",
      .file = "scene.lua",
      .text = "local m = material{ desnity = 5 }\n"
              "body{ box{1, 1}, material = m }",
      .code = SCENE_E_KEY,
      .message = "scene.lua:1:21: unknown key 'desnity' in material{} (did you mean 'density'?)" },
    { .what = "unknown key of body on its own line",
      .file = "scene.lua",
      .text = "body{\n"
              "  box{1, 1},\n"
              "  positon = {0, 1},\n"
              "}",
      .code = SCENE_E_KEY,
      .message = "scene.lua:3:3: unknown key 'positon' in body{} (did you mean 'at'?)" },
    { .what = "unknown key of a shape",
      .file = "scene.lua",
      .text = "body{ box{1, 1, rond = 0.1} }",
      .code = SCENE_E_KEY,
      .message = "scene.lua:1:17: unknown key 'rond' in box{} (did you mean 'round'?)" },
    { .what = "unknown key of expect",
      .file = "scene.lua",
      .text = "body{ box{1, 1} }\n"
              "expect{ \"slow\", max_sped = 1 }",
      .code = SCENE_E_KEY,
      .message = "scene.lua:2:17: unknown key 'max_sped' in expect{} (did you mean 'max_speed'?)" },
    { .what = "unknown key without a relative",
      .file = "scene.lua",
      .text = "body{ box{1, 1}, zzzzzz = 1 }",
      .code = SCENE_E_KEY,
      .message = "scene.lua:1:18: unknown key 'zzzzzz' in body{}" },
    { .what = "number wanted",
      .file = "scene.lua",
      .text = "body{ circle{\"big\"} }",
      .code = SCENE_E_TYPE,
      .message = "scene.lua:1:14: 'r' of circle{} must be a number, not a string" },
    { .what = "vector wanted",
      .file = "scene.lua",
      .text = "body{ box{1, 1}, at = 5 }",
      .code = SCENE_E_TYPE,
      .message = "scene.lua:1:18: 'at' of body{} must be two numbers {x, y}, not a number" },
    { .what = "vector of three",
      .file = "scene.lua",
      .text = "body{ box{1, 1},\n"
              "  at = {1, 2, 3} }",
      .code = SCENE_E_TYPE,
      .message = "scene.lua:2:3: 'at' of body{} must be two numbers {x, y}" },
    { .what = "vector of strings",
      .file = "scene.lua",
      .text = "body{ box{1, 1}, at = {\"1\", \"2\"} }",
      .code = SCENE_E_TYPE,
      .message = "scene.lua:1:18: 'at' of body{} must be two numbers {x, y}" },
    { .what = "string wanted",
      .file = "scene.lua",
      .text = "body{ box{1, 1}, name = 7 }",
      .code = SCENE_E_TYPE,
      .message = "scene.lua:1:18: 'name' of body{} must be a string, not a number" },
    { .what = "boolean wanted",
      .file = "scene.lua",
      .text = "body{ box{1, 1}, fixed_rotation = 1 }",
      .code = SCENE_E_TYPE,
      .message = "scene.lua:1:18: 'fixed_rotation' of body{} must be true or false, not a number" },
    { .what = "static asleep",
      .file = "scene.lua",
      .text = "body{ box{1, 1}, type = 'static', asleep = true }",
      .code = SCENE_E_CONFLICT,
      .message = "scene.lua:1:35: a static body{} cannot have 'asleep'" },
    { .what = "kinematic that sleeps",
      .file = "scene.lua",
      .text = "body{ box{1, 1}, type = 'kinematic', sleep = true }",
      .code = SCENE_E_CONFLICT,
      .message = "scene.lua:1:38: a kinematic body{} cannot have 'sleep'" },
    { .what = "asleep and moving",
      .file = "scene.lua",
      .text = "body{ box{1, 1}, asleep = true, velocity = {1, 0} }",
      .code = SCENE_E_CONFLICT,
      .message = "scene.lua:1:33: a sleeping body{} cannot have 'velocity'" },
    { .what = "asleep and sleepless",
      .file = "scene.lua",
      .text = "body{ box{1, 1}, asleep = true, sleep = false }",
      .code = SCENE_E_CONFLICT,
      .message = "scene.lua:1:33: a sleeping body{} cannot have 'sleep'" },
    { .what = "function wanted",
      .file = "scene.lua",
      .text = "body{ box{1, 1} }\n"
              "expect{ \"t\", test = true }",
      .code = SCENE_E_TYPE,
      .message = "scene.lua:2:14: 'test' of expect{} must be a function, not true" },
    { .what = "material wanted",
      .file = "scene.lua",
      .text = "body{ box{1, 1}, material = \"wood\" }",
      .code = SCENE_E_TYPE,
      .message = "scene.lua:1:18: 'material' of body{} must be a material, not a string" },
    { .what = "shape wanted",
      .file = "scene.lua",
      .text = "body{ box{1, 1}, 5 }",
      .code = SCENE_E_TYPE,
      .message = "scene.lua:1:18: value 2 in body{} must be a shape such as box{1, 1}, not a number" },
    { .what = "material in place of a shape",
      .file = "scene.lua",
      .text = "body{ material{} }",
      .code = SCENE_E_TYPE,
      .message = "scene.lua:1:7: value 1 in body{} must be a shape such as box{1, 1}, not a material" },
    { .what = "choice misspelt",
      .file = "scene.lua",
      .text = "body{ type = \"statc\", box{1, 1} }",
      .code = SCENE_E_RANGE,
      .message = "scene.lua:1:7: 'type' of body{} must be one of dynamic|kinematic|static, not 'statc' (did you mean 'static'?)" },
    { .what = "choice without a relative",
      .file = "scene.lua",
      .text = "scene{ y = \"sideways\" }\n"
              "body{ box{1, 1} }\n",
      .code = SCENE_E_RANGE,
      .message = "scene.lua:1:8: 'y' of scene{} must be one of up|down, not 'sideways'" },
    { .what = "integer wanted",
      .file = "scene.lua",
      .text = "scene{ substeps = 2.5 }\n"
              "body{ box{1, 1} }\n",
      .code = SCENE_E_TYPE,
      .message = "scene.lua:1:8: 'substeps' of scene{} must be an integer, not 2.5" },
    { .what = "substeps too many",
      .file = "scene.lua",
      .text = "scene{ substeps = 65 }\n"
              "body{ box{1, 1} }\n",
      .code = SCENE_E_RANGE,
      .message = "scene.lua:1:8: 'substeps' of scene{} must be at least 1 and at most 64, not 65" },
    { .what = "dt of zero",
      .file = "scene.lua",
      .text = "scene{ dt = 0 }\n"
              "body{ box{1, 1} }\n",
      .code = SCENE_E_RANGE,
      .message = "scene.lua:1:8: 'dt' of scene{} must be above 0 and at most 1 s, not 0" },
    { .what = "dt not finite",
      .file = "scene.lua",
      .text = "scene{ dt = 0/0 }\n"
              "body{ box{1, 1} }\n",
      .code = SCENE_E_RANGE,
      .message = "scene.lua:1:8: 'dt' of scene{} must be finite, not nan" },
    { .what = "position infinite",
      .file = "scene.lua",
      .text = "body{ box{1, 1}, at = {math.huge, 0} }",
      .code = SCENE_E_RANGE,
      .message = "scene.lua:1:18: 'at' of body{} must be finite, not inf" },
    { .what = "restitution above 1",
      .file = "scene.lua",
      .text = "local m = material{\n"
              "  friction = 0.5,\n"
              "  restitution = 1.5 }\n"
              "body{ box{1, 1}, material = m }",
      .code = SCENE_E_RANGE,
      .message = "scene.lua:3:3: 'restitution' of material{} must be at least 0 and at most 1, not 1.5" },
    { .what = "friction negative",
      .file = "scene.lua",
      .text = "local m = material{ friction = -1 }\n"
              "body{ box{1, 1}, material = m }",
      .code = SCENE_E_RANGE,
      .message = "scene.lua:1:21: 'friction' of material{} must be at least 0 and at most 10, not -1" },
    { .what = "density of zero",
      .file = "scene.lua",
      .text = "local m = material{ density = 0 }\n"
              "body{ box{1, 1}, material = m }",
      .code = SCENE_E_RANGE,
      .message = "scene.lua:1:21: 'density' of material{} must be above 0 and at most 1000000000 kg/m^2, not 0" },
    { .what = "radius negative",
      .file = "scene.lua",
      .text = "body{ circle{-1} }",
      .code = SCENE_E_RANGE,
      .message = "scene.lua:1:14: 'r' of circle{} must be at least 0.0001 and at most 10000000 m, not -1" },
    { .what = "box without height",
      .file = "scene.lua",
      .text = "body{ box{1} }",
      .code = SCENE_E_MISSING,
      .message = "scene.lua:1:7: box{} needs 'h'" },
    { .what = "circle without radius",
      .file = "scene.lua",
      .text = "body{ circle{} }",
      .code = SCENE_E_MISSING,
      .message = "scene.lua:1:7: circle{} needs 'r'" },
    { .what = "too many values by position",
      .file = "scene.lua",
      .text = "body{ box{1, 2, 3} }",
      .code = SCENE_E_KEY,
      .message = "scene.lua:1:17: box{} takes 2 values by position, not 3" },
    { .what = "twice the same",
      .file = "scene.lua",
      .text = "body{ box{1, 1, w = 2} }",
      .code = SCENE_E_DUPLICATE,
      .message = "scene.lua:1:17: 'w' of box{} is given by name and by position" },
    { .what = "body without shape",
      .file = "scene.lua",
      .text = "body{ at = {0, 1} }",
      .code = SCENE_E_MISSING,
      .message = "scene.lua:1:1: body{} needs a shape such as box{1, 1}" },
    { .what = "hole in the shapes",
      .file = "scene.lua",
      .text = "body{ box{1, 1}, nil, box{2, 2} }",
      .code = SCENE_E_MISSING,
      .message = "scene.lua:1:1: the array part of body{} has a nil in it" },
    { .what = "two bodies of one name",
      .file = "scene.lua",
      .text = "body{ name = \"a\", box{1, 1} }\n"
              "body{ name = \"a\", box{1, 1}, at = {3, 0} }",
      .code = SCENE_E_DUPLICATE,
      .message = "scene.lua:2:7: two bodies are called 'a'" },
    { .what = "empty name",
      .file = "scene.lua",
      .text = "body{ name = \"\", box{1, 1} }",
      .code = SCENE_E_RANGE,
      .message = "scene.lua:1:7: 'name' of body{} must not be empty" },
    { .what = "star in a name",
      .file = "scene.lua",
      .text = "body{ name = \"a*\", box{1, 1} }",
      .code = SCENE_E_RANGE,
      .message = "scene.lua:1:7: 'name' of body{} must not contain '*': it stands for any ending elsewhere" },
    { .what = "static body with velocity",
      .file = "scene.lua",
      .text = "body{ type = \"static\", box{1, 1}, velocity = {1, 0} }",
      .code = SCENE_E_CONFLICT,
      .message = "scene.lua:1:35: a static body{} cannot have 'velocity'" },
    { .what = "kinematic body with mass",
      .file = "scene.lua",
      .text = "body{ type = \"kinematic\", mass = 1, box{1, 1} }",
      .code = SCENE_E_CONFLICT,
      .message = "scene.lua:1:27: a kinematic body{} cannot have 'mass'" },
    { .what = "both angles",
      .file = "scene.lua",
      .text = "body{ box{1, 1}, angle = 1, angle_deg = 30 }",
      .code = SCENE_E_CONFLICT,
      .message = "scene.lua:1:29: body{} has both 'angle' and 'angle_deg'" },
    { .what = "dynamic chain without mass",
      .file = "scene.lua",
      .text = "body{ chain{{0, 0}, {1, 0}} }",
      .code = SCENE_E_MISSING,
      .message = "scene.lua:1:1: a dynamic body{} of segments and chains needs 'mass'" },
    { .what = "polygon of two points",
      .file = "scene.lua",
      .text = "body{ polygon{{0, 0}, {1, 0}} }",
      .code = SCENE_E_RANGE,
      .message = "scene.lua:1:7: polygon{} needs 3 to 64 points, not 2" },
    { .what = "polygon without area",
      .file = "scene.lua",
      .text = "body{ polygon{{0, 0}, {1, 0}, {2, 0}} }",
      .code = SCENE_E_GEOMETRY,
      .message = "scene.lua:1:7: this polygon{} has no area" },
    { .what = "polygon not convex",
      .file = "scene.lua",
      .text = "body{ polygon{{0, 0}, {2, 0}, {0.5, 0.5}, {0, 2}} }",
      .code = SCENE_E_GEOMETRY,
      .message = "scene.lua:1:7: this polygon{} is not convex, or its points are not in order (did you mean 'outline'?)" },
    { .what = "outline that crosses itself",
      .file = "scene.lua",
      .text = "body{ outline{{0, 0}, {1, 1}, {1, 0}, {0, 1}} }",
      .code = SCENE_E_GEOMETRY,
      .message = "scene.lua:1:7: this outline{} crosses or touches itself, or has no area" },
    { .what = "chain with equal points",
      .file = "scene.lua",
      .text = "body{ type = \"static\", chain{{0, 0}, {1, 0}, {1, 0}} }",
      .code = SCENE_E_GEOMETRY,
      .message = "scene.lua:1:24: points 2 and 3 of chain{} are less than 0.0001 m apart" },
    { .what = "point that is no point",
      .file = "scene.lua",
      .text = "body{ polygon{{0, 0}, {1, 0}, {1}} }",
      .code = SCENE_E_TYPE,
      .message = "scene.lua:1:31: point 3 of polygon{} must be two numbers {x, y}, not another table" },
    { .what = "regular of 17 corners",
      .file = "scene.lua",
      .text = "body{ regular(17, 1) }",
      .code = SCENE_E_RANGE,
      .message = "scene.lua:1:15: 'n' of regular{} must be at least 3 and at most 16 corners, not 17" },
    { .what = "shape never used",
      .file = "scene.lua",
      .text = "box{1, 1}\n"
              "body{ box{1, 1} }\n",
      .code = SCENE_E_UNUSED,
      .message = "scene.lua:1:1: this box{} is never used: put it into a body{}" },
    { .what = "shape overwritten",
      .file = "scene.lua",
      .text = "local b = box{1, 1}\n"
              "b = circle{1}\n"
              "body{ b }",
      .code = SCENE_E_UNUSED,
      .message = "scene.lua:1:11: this box{} is never used: put it into a body{}" },
    { .what = "material never used",
      .file = "scene.lua",
      .text = "local m = material{ friction = 0 }\n"
              "body{ box{1, 1} }\n",
      .code = SCENE_E_UNUSED,
      .message = "scene.lua:1:11: this material{} is never used: give it to a body{} or a shape" },
    { .what = "scene twice",
      .file = "scene.lua",
      .text = "scene{ dt = 0.01 }\n"
              "scene{ dt = 0.02 }",
      .code = SCENE_E_DUPLICATE,
      .message = "scene.lua:2:1: scene{} was called before, on line 1" },
    { .what = "scene after a body",
      .file = "scene.lua",
      .text = "body{ box{1, 1} }\n"
              "scene{ dt = 0.02 }",
      .code = SCENE_E_STATE,
      .message = "scene.lua:2:1: scene{} must come before the first material{} and body{}" },
    { .what = "camera twice",
      .file = "scene.lua",
      .text = "body{ box{1, 1} }\n"
              "camera{ center = {0, 0}, height = 5 }\n"
              "camera{ center = {0, 0}, height = 5 }",
      .code = SCENE_E_DUPLICATE,
      .message = "scene.lua:3:1: camera{} was called before, on line 2" },
    { .what = "camera with fit and center",
      .file = "scene.lua",
      .text = "body{ box{1, 1} }\n"
              "camera{ fit = {{0, 0}, {1, 1}}, center = {0, 0}, height = 1 }",
      .code = SCENE_E_CONFLICT,
      .message = "scene.lua:2:9: camera{} takes either 'fit' or 'center' and 'height'" },
    { .what = "camera follows nobody",
      .file = "scene.lua",
      .text = "body{ name = \"ball\", circle{1} }\n"
              "camera{ follow = \"bal\" }",
      .code = SCENE_E_NAME,
      .message = "scene.lua:2:9: no body is called 'bal' (did you mean 'ball'?)" },
    { .what = "bad color",
      .file = "scene.lua",
      .text = "body{ box{1, 1}, color = \"red\" }",
      .code = SCENE_E_TYPE,
      .message = "scene.lua:1:18: 'color' of body{} must be \"#rrggbb\" or a palette number 0..1000" },
    { .what = "unknown global",
      .file = "scene.lua",
      .text = "bdoy{ box{1, 1} }",
      .code = SCENE_E_NAME,
      .message = "scene.lua:1:1: unknown name 'bdoy' (did you mean 'body'?)" },
    { .what = "io is not there",
      .file = "scene.lua",
      .text = "io.open(\"x\")",
      .code = SCENE_E_NAME,
      .message = "scene.lua:1:1: unknown name 'io'" },
    { .what = "math.sine",
      .file = "scene.lua",
      .text = "body{ box{1, math.sine(1)} }",
      .code = SCENE_E_NAME,
      .message = "scene.lua:1:19: math has no 'sine' (did you mean 'sin'?)" },
    { .what = "string.dump",
      .file = "scene.lua",
      .text = "print(string.dump(print))",
      .code = SCENE_E_NAME,
      .message = "scene.lua:1:14: string has no 'dump'" },
    { .what = "syntax error",
      .file = "scene.lua",
      .text = "body{ box{1, 1} \n"
              "body{ box{1, 1} }",
      .code = SCENE_E_SYNTAX,
      .message = "scene.lua:2:1: '}' expected (to close '{' at line 1) near 'body'" },
    { .what = "syntax error at the end",
      .file = "scene.lua",
      .text = "for i = 1, 3 do\n"
              "body{ box{1, 1} }\n",
      .code = SCENE_E_SYNTAX,
      .message = "scene.lua:3:1: 'end' expected (to close 'for' at line 1) near <eof>" },
    { .what = "unfinished string",
      .file = "scene.lua",
      .text = "body{ name = \"abc }",
      .code = SCENE_E_SYNTAX,
      .message = "scene.lua:1:20: unfinished string near <eof>" },
    { .what = "power",
      .file = "scene.lua",
      .text = "body{ box{1, 2^3} }",
      .code = SCENE_E_SYNTAX,
      .message = "scene.lua:1:15: only x^2 is offered: other powers differ in the last place from machine to machine (did you mean 'math.pow(x, y)'?)" },
    { .what = "nil indexed",
      .file = "scene.lua",
      .text = "local x\n"
              "print(x.y)",
      .code = SCENE_E_RUNTIME,
      .message = "scene.lua:2:7: attempt to index a nil value (local 'x')" },
    { .what = "arithmetic on nil",
      .file = "scene.lua",
      .text = "local w = {}\n"
              "body{ box{1, w.width + 1} }",
      .code = SCENE_E_RUNTIME,
      .message = "scene.lua:2:16: attempt to perform arithmetic on a nil value (field 'width')" },
    { .what = "error()",
      .file = "scene.lua",
      .text = "error(\"no \" .. \"way\")",
      .code = SCENE_E_RUNTIME,
      .message = "scene.lua:1:1: no way" },
    { .what = "assert",
      .file = "scene.lua",
      .text = "local n = 3\n"
              "assert(n == 4, \"n is three\")",
      .code = SCENE_E_RUNTIME,
      .message = "scene.lua:2:1: n is three" },
    { .what = "bad argument of Lua",
      .file = "scene.lua",
      .text = "print(math.floor({}))",
      .code = SCENE_E_RUNTIME,
      .message = "scene.lua:1:12: bad argument #1 to 'floor' (number expected, got table)" },
    { .what = "endless loop",
      .file = "scene.lua",
      .text = "while true do end",
      .code = SCENE_E_LIMIT,
      .message = "scene.lua:1:1: the scene takes more than 5000000 instructions" },
    { .what = "endless recursion",
      .file = "scene.lua",
      .text = "local function f() return 1 + f() end\n"
              "f()",
      .code = SCENE_E_RUNTIME,
      .message = "scene.lua:1:1: stack overflow" },
    { .what = "memory",
      .file = "scene.lua",
      .text = "local t = {}\n"
              "for i = 1, 1e9 do t[i] = (\"x\"):rep(60000) .. i end",
      .code = SCENE_E_LIMIT,
      .message = "scene.lua:2:1: the scene needs more than 134217728 bytes of memory" },
    { .what = "string.rep",
      .file = "scene.lua",
      .text = "local s = (\"x\"):rep(1e9)",
      .code = SCENE_E_RUNTIME,
      .message = "scene.lua:1:1: a string of more than 65536 bytes was made" },
    { .what = "doubling string",
      .file = "scene.lua",
      .text = "local s = \"x\"\n"
              "while true do s = s .. s end",
      .code = SCENE_E_LIMIT,
      .message = "scene.lua:2:1: a string of more than 65536 bytes was made" },
    { .what = "at never happens",
      .file = "scene.lua",
      .text = "scene{ duration = 5 }\n"
              "body{ box{1, 1} }\n"
              "at(6, function() end)",
      .code = SCENE_E_RANGE,
      .message = "scene.lua:3:4: at(6) never happens: the scene ends at 5 s" },
    { .what = "at without function",
      .file = "scene.lua",
      .text = "body{ box{1, 1} }\n"
              "at(1)",
      .code = SCENE_E_TYPE,
      .message = "scene.lua:2:1: at takes a time in seconds and a function" },
    { .what = "every zero",
      .file = "scene.lua",
      .text = "body{ box{1, 1} }\n"
              "every(0, function() end)",
      .code = SCENE_E_RANGE,
      .message = "scene.lua:2:7: the time of every() must be above 0 and finite, not 0" },
    { .what = "expect after the end",
      .file = "scene.lua",
      .text = "scene{ duration = 5 }\n"
              "body{ box{1, 1} }\n"
              "expect{ \"late\", at = 6, max_speed = 1 }",
      .code = SCENE_E_RANGE,
      .message = "scene.lua:3:17: 'at' of expect{} is 6 s, after the end of the scene at 5 s" },
    { .what = "expect nothing",
      .file = "scene.lua",
      .text = "body{ box{1, 1} }\n"
              "expect{ \"nothing\" }",
      .code = SCENE_E_MISSING,
      .message = "scene.lua:2:1: expect{} needs something to measure, such as max_penetration = 0.005" },
    { .what = "expect without name",
      .file = "scene.lua",
      .text = "body{ box{1, 1} }\n"
              "expect{ max_speed = 1 }",
      .code = SCENE_E_MISSING,
      .message = "scene.lua:2:1: expect{} needs 'name'" },
    { .what = "expect unknown body",
      .file = "scene.lua",
      .text = "body{ name = \"ball\", circle{1} }\n"
              "expect{ \"x\", body = \"bell\", y = 1 }",
      .code = SCENE_E_NAME,
      .message = "scene.lua:2:14: no body is called 'bell' (did you mean 'ball'?)" },
    { .what = "expect position without body",
      .file = "scene.lua",
      .text = "body{ box{1, 1} }\n"
              "expect{ \"x\", y = 1 }",
      .code = SCENE_E_MISSING,
      .message = "scene.lua:2:1: expect{} needs 'body' to know whose position, angle or velocity is meant" },
    { .what = "expect empty range",
      .file = "scene.lua",
      .text = "body{ name = \"ball\", circle{1} }\n"
              "expect{ \"x\", body = \"ball\", y = {2, 1} }",
      .code = SCENE_E_RANGE,
      .message = "scene.lua:2:29: 'y' of expect{} is empty: min 2 is above max 1" },
    { .what = "expect at and always",
      .file = "scene.lua",
      .text = "body{ box{1, 1} }\n"
              "expect{ \"x\", at = 1, always = true, max_speed = 1 }",
      .code = SCENE_E_CONFLICT,
      .message = "scene.lua:2:14: expect{} takes one of 'at', 'always' and 'from'/'till'" },
    { .what = "on_contact unknown body",
      .file = "scene.lua",
      .text = "body{ name = \"ball\", circle{1} }\n"
              "on_contact{ a = \"boll\", function() end }",
      .code = SCENE_E_NAME,
      .message = "scene.lua:2:13: no body is called 'boll' (did you mean 'ball'?)" },
    { .what = "on_contact without function",
      .file = "scene.lua",
      .text = "body{ box{1, 1} }\n"
              "on_contact{ a = \"body1\" }",
      .code = SCENE_E_MISSING,
      .message = "scene.lua:2:1: on_contact{} needs a function" },
    { .what = "exact without function",
      .file = "scene.lua",
      .text = "body{ name = \"ball\", circle{1} }\n"
              "exact{ body = \"ball\" }",
      .code = SCENE_E_MISSING,
      .message = "scene.lua:2:1: exact{} needs a function of time, such as y = function(t) ... end" },
    { .what = "param twice",
      .file = "scene.lua",
      .text = "local n = param(\"n\", 1)\n"
              "local m = param(\"n\", 2)\n"
              "body{ box{1, 1} }\n",
      .code = SCENE_E_DUPLICATE,
      .message = "scene.lua:2:17: param 'n' is declared twice" },
    { .what = "param named like scene",
      .file = "scene.lua",
      .text = "local n = param(\"dt\", 1)\n"
              "body{ box{1, 1} }\n",
      .code = SCENE_E_DUPLICATE,
      .message = "scene.lua:1:17: param 'dt' has the name of a key of scene{}" },
    { .what = "param default out of range",
      .file = "scene.lua",
      .text = "local n = param(\"n\", 0, 1, 5)\n"
              "body{ box{1, 1} }\n",
      .code = SCENE_E_RANGE,
      .message = "scene.lua:1:22: param 'n' must be from 1 to 5, not 0" },
    { .what = "body misused",
      .file = "scene.lua",
      .text = "local b = body{ box{1, 1} }\n"
              "b.position = 5",
      .code = SCENE_E_STATE,
      .message = "scene.lua:2:1: a body's 'position' cannot be assigned: call a method, or keep values in body.user" },
    { .what = "unknown method",
      .file = "scene.lua",
      .text = "local b = body{ box{1, 1} }\n"
              "print(b:positon())",
      .code = SCENE_E_NAME,
      .message = "scene.lua:2:9: a body has no 'positon' (did you mean 'position'?)" },
    { .what = "method without colon",
      .file = "scene.lua",
      .text = "local b = body{ box{1, 1} }\n"
              "print(b.position())",
      .code = SCENE_E_TYPE,
      .message = "scene.lua:2:9: position is a method: write body:position(...)" },
    { .what = "dead body",
      .file = "scene.lua",
      .text = "local b = body{ box{1, 1} }\n"
              "b:destroy()\n"
              "print(b:position())",
      .code = SCENE_E_STATE,
      .message = "scene.lua:3:9: position() of a body that was destroyed" },
    { .what = "force on a static body",
      .file = "scene.lua",
      .text = "local b = body{ type = \"static\", box{1, 1} }\n"
              "b:apply_force(1, 0)",
      .code = SCENE_E_STATE,
      .message = "scene.lua:2:3: apply_force() of 'body1': the body's type does not allow it" },
    { .what = "--set of nothing known",
      .file = "scene.lua",
      .text = "body{ box{1, 1} }\n",
      .code = SCENE_E_SET,
      .message = "--set gravty: neither a key of scene{} nor a param of this scene (did you mean 'gravity'?)",
      .set = "gravty=0,1" },
    { .what = "--set misspelt param",
      .file = "scene.lua",
      .text = "local count = param(\"count\", 3)\n"
              "body{ box{1, 1} }\n",
      .code = SCENE_E_SET,
      .message = "--set cout: neither a key of scene{} nor a param of this scene (did you mean 'count'?)",
      .set = "cout=5" },
    { .what = "--set wrong type",
      .file = "scene.lua",
      .text = "body{ box{1, 1} }\n",
      .code = SCENE_E_TYPE,
      .message = "--set dt: 'dt' of scene{} must be a number, not a string",
      .set = "dt=fast" },
    { .what = "--set out of range",
      .file = "scene.lua",
      .text = "scene{ substeps = 4 }\n"
              "body{ box{1, 1} }\n",
      .code = SCENE_E_RANGE,
      .message = "--set substeps: 'substeps' of scene{} must be at least 1 and at most 64, not 100",
      .set = "substeps=100" },
    { .what = "--set param out of range",
      .file = "scene.lua",
      .text = "local count = param(\"count\", 3, 1, 10)\n"
              "body{ box{1, 1} }\n",
      .code = SCENE_E_RANGE,
      .message = "--set count: param 'count' must be from 1 to 10, not 50",
      .set = "count=50" },
    { .what = "--set param wrong type",
      .file = "scene.lua",
      .text = "local count = param(\"count\", 3)\n"
              "body{ box{1, 1} }\n",
      .code = SCENE_E_TYPE,
      .message = "--set count: param 'count' must be an integer like its default, not 2.5",
      .set = "count=2.5" },
    { .what = "--set without =",
      .file = "scene.lua",
      .text = "body{ box{1, 1} }\n",
      .code = SCENE_E_SET,
      .message = "--set count: must have the form key=value",
      .set = "count" },
    { .what = "json syntax",
      .file = "scene.json",
      .text = "{\"bodies\":[}",
      .code = SCENE_E_SYNTAX,
      .message = "scene.json:1:12: this is not JSON" },
    { .what = "json rest",
      .file = "scene.json",
      .text = "{\"format\":\"plumb-scene-1\"} 5",
      .code = SCENE_E_SYNTAX,
      .message = "scene.json:1:28: something follows the end of the scene" },
    { .what = "json no format",
      .file = "scene.json",
      .text = "{\"bodies\":[]}",
      .code = SCENE_E_MISSING,
      .message = "scene.json:1:1: a scene needs \"format\":\"plumb-scene-1\"" },
    { .what = "json array",
      .file = "scene.json",
      .text = "[]",
      .code = SCENE_E_TYPE,
      .message = "scene.json:1:1: a scene must be an object {...}" },
    { .what = "json unknown key",
      .file = "scene.json",
      .text = "{\"format\":\"plumb-scene-1\",\n"
              " \"bodes\":[]}",
      .code = SCENE_E_KEY,
      .message = "scene.json:2:2: unknown key 'bodes' in a scene (did you mean 'bodies'?)" },
    { .what = "json key twice",
      .file = "scene.json",
      .text = "{\"format\":\"plumb-scene-1\",\n"
              " \"bodies\":[], \"bodies\":[]}",
      .code = SCENE_E_DUPLICATE,
      .message = "scene.json:2:2: key 'bodies' is given twice" },
    { .what = "json body key",
      .file = "scene.json",
      .text = "{\"format\":\"plumb-scene-1\",\n"
              " \"bodies\":[{\"shapes\":[{\"kind\":\"box\",\"w\":1,\"h\":1}]},\n"
              "  {\"colr\":1, \"shapes\":[{\"kind\":\"circle\",\"r\":1}]}]}",
      .code = SCENE_E_KEY,
      .message = "scene.json:3:4: unknown key 'colr' in body{} (did you mean 'color'?)" },
    { .what = "json body type",
      .file = "scene.json",
      .text = "{\"format\":\"plumb-scene-1\", \"bodies\":[{\"at\":[1,\"x\"],\"shapes\":[{\"kind\":\"circle\",\"r\":1}]}]}",
      .code = SCENE_E_TYPE,
      .message = "scene.json:1:39: 'at' of body{} must be two numbers {x, y}" },
    { .what = "json kind",
      .file = "scene.json",
      .text = "{\"format\":\"plumb-scene-1\", \"bodies\":[{\"shapes\":[{\"kind\":\"cirle\",\"r\":1}]}]}",
      .code = SCENE_E_NAME,
      .message = "scene.json:1:50: unknown kind of shape 'cirle' (did you mean 'circle'?)" },
    { .what = "json shape range",
      .file = "scene.json",
      .text = "{\"format\":\"plumb-scene-1\", \"bodies\":[{\"shapes\":[{\"kind\":\"circle\",\"r\":-1}]}]}",
      .code = SCENE_E_RANGE,
      .message = "scene.json:1:66: 'r' of circle{} must be at least 0.0001 and at most 10000000 m, not -1" },
    { .what = "json material",
      .file = "scene.json",
      .text = "{\"format\":\"plumb-scene-1\", \"materials\":[{\"name\":\"wood\"}],\n"
              " \"bodies\":[{\"material\":\"wod\",\"shapes\":[{\"kind\":\"circle\",\"r\":1}]}]}",
      .code = SCENE_E_NAME,
      .message = "scene.json:2:13: no material is called 'wod' (did you mean 'wood'?)" },
    { .what = "json null",
      .file = "scene.json",
      .text = "{\"format\":\"plumb-scene-1\", \"bodies\":[{\"at\":null}]}",
      .code = SCENE_E_TYPE,
      .message = "scene.json:1:39: null is not a value of a scene" },
    { .what = "json time",
      .file = "scene.json",
      .text = "{\"format\":\"plumb-scene-1\", \"time\":-1}",
      .code = SCENE_E_TYPE,
      .message = "scene.json:1:28: 'time' must be a number of at least 0 [s]" },
};
// clang-format on

static void test_malformed_scenes(void **state)
{
    (void)state;
    int wrong = 0;
    for (size_t i = 0; i < sizeof table / sizeof *table; i++) {
        const malformed *m = &table[i];
        scene_options options = { .path = m->file,
                                  .text = m->text,
                                  .text_size = strlen(m->text),
                                  .sets = &m->set,
                                  .set_count = m->set != NULL,
                                  .memory_limit = (size_t)128 << 20,
                                  .build_instructions = 5000000 };
        scene *s = (scene *)&options; // anything but null
        scene_error e;
        scene_code code = scene_load(&options, &s, &e);
        bool right =
            code == m->code && e.code == code && s == NULL && strcmp(e.text, m->message) == 0;
        if (!right) {
            printf("%s\n  expected %d %s\n  got      %d %s\n", m->what, m->code, m->message, code,
                   e.text);
            wrong++;
        }
        scene_destroy(s);
    }
    assert_int_equal(wrong, 0);
    assert_true(sizeof table / sizeof *table >= 40);
}

static scene *load(const char *text)
{
    scene *s;
    scene_error e;
    scene_load(&(scene_options){ .path = "scene.lua",
                                 .text = text,
                                 .text_size = strlen(text),
                                 .handler_instructions = 100000 },
               &s, &e);
    if (s == NULL) {
        printf("%s\n", e.text);
    }
    assert_non_null(s);
    return s;
}

// Errors of handlers come out of scene_step, with their place, again and again.
static void test_handler_errors(void **state)
{
    (void)state;
    static const char *const rows[][2] = {
        { "body{ name = 'b', box{1, 1} }\nat(0, function()\n  find('b'):set_velocity('x', 0)\nend)",
          "scene.lua:3:13: bad argument #1 to 'set_velocity' (number expected, got string)" },
        { "body{ name = 'b', box{1, 1} }\nat(0, function() while true do end end)",
          "scene.lua:2:1: the handler takes more than 100000 instructions" },
        { "body{ box{1, 1} }\nat(0, function()\n  body{ box{1, -1} }\nend)",
          "scene.lua:3:16: 'h' of box{} must be at least 0.0002 and at most 10000000 m, not -1" },
        { "body{ box{1, 1} }\nevery_step(function()\n  local b = nil + 1\nend)",
          "scene.lua:3:3: attempt to perform arithmetic on a nil value" },
        { "body{ box{1, 1} }\nat(0, function() expect{ 'late', max_speed = 1 } end)",
          "scene.lua:2:18: expect{} belongs to the script, not to a handler" },
        { "body{ name = 'b', box{1, 1} }\nat(0, function() local b = find('b') b:destroy() "
          "b:mass() end)",
          "scene.lua:2:52: mass() of a body that was destroyed" },
    };
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        scene *s = load(rows[i][0]);
        scene_error e = { 0 };
        scene_error again = { 0 };
        scene_code code = scene_step(s, &e);
        assert_int_not_equal(code, SCENE_OK);
        assert_string_equal(e.text, rows[i][1]);
        assert_int_equal(scene_step(s, &again), code);
        assert_string_equal(again.text, e.text);
        assert_true(scene_done(s));
        scene_destroy(s);
    }
}

static void test_arguments(void **state)
{
    (void)state;
    scene *s;
    scene_error e;
    assert_int_equal(scene_load(NULL, &s, &e), SCENE_E_ARGUMENT);
    assert_int_equal(scene_load(&(scene_options){ 0 }, &s, &e), SCENE_E_ARGUMENT);
    assert_int_equal(scene_load(&(scene_options){ .path = "x.lua" }, NULL, NULL), SCENE_E_ARGUMENT);
    assert_int_equal(scene_load(&(scene_options){ .path = "/no/such/file.lua" }, &s, &e),
                     SCENE_E_IO);
    assert_string_equal(e.text, "/no/such/file.lua: cannot be opened");
    assert_int_equal(scene_load(&(scene_options){ .text = "", .memory_limit = 1000 }, &s, &e),
                     SCENE_E_LIMIT);
    assert_string_equal(e.text, "scene: the memory limit leaves no room for the script");
    assert_string_equal(scene_code_text(SCENE_E_KEY), "an unknown key");
    assert_string_equal(scene_code_text((scene_code)99), "unknown code");
    scene_destroy(NULL);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_malformed_scenes),
        cmocka_unit_test(test_handler_errors),
        cmocka_unit_test(test_arguments),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
