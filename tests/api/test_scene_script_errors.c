// test_scene_script_errors.c - what goes wrong in the script of a scene: Lua itself, its limits, handlers,
// expectations, params, --set, JSON. Each with the exact code and message that it must give.
#include "malformed.h"

// clang-format off
static const malformed table[] = {
    { .what = "unknown global",
      .file = "scene.lua",
      .text = "bdoy{ box{1, 1} }",
      .code = SCENE_E_NAME,
      .message = "scene.lua:1:1: unknown name 'bdoy' (did you mean 'body'?)" },
    { .what = "io is not there",
      .file = "scene.lua",
      .text = "io.open(\"x\")",
      .code = SCENE_E_NAME,
      .message = "scene.lua:1:1: unknown name 'io'; a scene reads and writes no files" },
    { .what = "math.sine",
      .file = "scene.lua",
      .text = "body{ box{1, math.sine(1)} }",
      .code = SCENE_E_NAME,
      .message = "scene.lua:1:19: math has no 'sine' (did you mean 'sin'?)" },
    { .what = "math.random",
      .file = "scene.lua",
      .text = "body{ box{1, 1}, at = {math.random(), 2} }",
      .code = SCENE_E_NAME,
      .message = "scene.lua:1:29: math has no 'random'; random(a, b) and random_int(a, b) follow scene{seed}" },
    { .what = "table.unpack of too much",
      .file = "scene.lua",
      .text = "local t = {}\n"
              "for i = 1, 10001 do t[i] = i end\n"
              "print(table.unpack(t))",
      .code = SCENE_E_RUNTIME,
      .message = "scene.lua:3:13: bad argument #1 to 'unpack' (has more than the 10000 values that unpack gives)" },
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
    { .what = "parts shorter than any step",
      .file = "scene.lua",
      .text = "split_step(20000)",
      .code = SCENE_E_RUNTIME,
      .message =
          "scene.lua:1:1: bad argument #1 to 'split_step' (makes steps shorter than 1e-6 s)" },
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
      .text = "local t, x = {}, (\"x\"):rep(60000)\n"
              "for i = 1, 1e9 do t[i] = x .. i end",
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
    { .what = "exact without body",
      .file = "scene.lua",
      .text = "body{ name = \"ball\", circle{1} }\n"
              "exact{ y = function() return 1 end }",
      .code = SCENE_E_MISSING,
      .message = "scene.lua:2:1: exact{} needs 'body' to know whose motion is meant" },
    { .what = "exact of two kinds",
      .file = "scene.lua",
      .text = "body{ name = \"ball\", circle{1} }\n"
              "exact{ body = \"ball\", y = function() return 1 end, measure = "
              "function() return 1 end, value = function() return 1 end }",
      .code = SCENE_E_CONFLICT,
      .message = "scene.lua:2:52: exact{} takes the motion of a body or 'measure' and 'value', "
                 "not both" },
    { .what = "exact without value",
      .file = "scene.lua",
      .text = "body{ name = \"ball\", circle{1} }\n"
              "exact{ measure = function() return 1 end }",
      .code = SCENE_E_MISSING,
      .message = "scene.lua:2:1: exact{} needs 'measure' and 'value' together" },
    { .what = "exact unit of motion",
      .file = "scene.lua",
      .text = "body{ name = \"ball\", circle{1} }\n"
              "exact{ body = \"ball\", y = function() return 1 end, unit = \"m\" }",
      .code = SCENE_E_UNUSED,
      .message = "scene.lua:2:52: 'unit' of exact{} is for 'measure': motion has units of its own" },
    { .what = "exact at and till",
      .file = "scene.lua",
      .text = "body{ name = \"ball\", circle{1} }\n"
              "exact{ body = \"ball\", y = function() return 1 end, at = 1, till = 2 }",
      .code = SCENE_E_CONFLICT,
      .message = "scene.lua:2:52: exact{} takes one of 'at' and 'from'/'till'" },
    { .what = "exact twice",
      .file = "scene.lua",
      .text = "body{ name = \"ball\", circle{1} }\n"
              "for i = 1, 2 do exact{ \"fall\", body = \"ball\", y = function() return 1 end } end",
      .code = SCENE_E_DUPLICATE,
      .message = "scene.lua:2:17: another exact{} is called 'fall'" },
    { .what = "expect unknown exact",
      .file = "scene.lua",
      .text = "body{ name = \"ball\", circle{1} }\n"
              "exact{ \"fall\", body = \"ball\", y = function() return 1 end } "
              "expect{ \"x\", exact = \"fell\", tolerance = 1 }",
      .code = SCENE_E_NAME,
      .message = "scene.lua:2:74: no exact{} is called 'fell' (did you mean 'fall'?)" },
    { .what = "expect exact without tolerance",
      .file = "scene.lua",
      .text = "body{ name = \"ball\", circle{1} }\n"
              "exact{ \"fall\", body = \"ball\", y = function() return 1 end } "
              "expect{ \"x\", exact = \"fall\" }",
      .code = SCENE_E_MISSING,
      .message = "scene.lua:2:74: expect{} with 'exact' needs 'tolerance'" },
    { .what = "field misused",
      .file = "scene.lua",
      .text = "body{ name = \"ball\", circle{1} }\n"
              "field(function() end)",
      .code = SCENE_E_TYPE,
      .message = "scene.lua:2:1: field takes one table: field{body = ..., function}" },
    { .what = "field without body",
      .file = "scene.lua",
      .text = "body{ name = \"ball\", circle{1} }\n"
              "field{ function() end }",
      .code = SCENE_E_MISSING,
      .message = "scene.lua:2:1: field{} needs 'body'" },
    { .what = "field of nobody",
      .file = "scene.lua",
      .text = "body{ name = \"ball\", circle{1} }\n"
              "field{ body = \"bell\", function() end }",
      .code = SCENE_E_NAME,
      .message = "scene.lua:2:8: no body is called 'bell' (did you mean 'ball'?)" },
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
      .message = "scene.lua:2:3: a body's 'position' cannot be assigned: call a method, or keep values in body.user" },
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
      .message = "scene.lua:2:3: apply_force() of 'body1': body is static; it must be dynamic" },
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
      .message = "scene.json:1:12: expected a value: a number, \"text\", true, false, [...] or {...}" },
    { .what = "json nothing",
      .file = "scene.json",
      .text = " \n",
      .code = SCENE_E_SYNTAX,
      .message = "scene.json:2:1: the file is empty" },
    { .what = "json cut off",
      .file = "scene.json",
      .text = "{\"format\":\"plumb-scene-1\",\n\"bodies\":[{\"name\":\"a\"}",
      .code = SCENE_E_SYNTAX,
      .message = "scene.json:2:23: the file ends here, within an object or array" },
    { .what = "json text without end",
      .file = "scene.json",
      .text = "{\"format\":\"plumb-scene-1}",
      .code = SCENE_E_SYNTAX,
      .message = "scene.json:1:11: this text has no end: a quotation mark is missing" },
    { .what = "json key without quotes",
      .file = "scene.json",
      .text = "{\"format\":\"plumb-scene-1\", bodies:[]}",
      .code = SCENE_E_SYNTAX,
      .message = "scene.json:1:28: expected a key in quotation marks" },
    { .what = "json no colon",
      .file = "scene.json",
      .text = "{\"format\" \"plumb-scene-1\"}",
      .code = SCENE_E_SYNTAX,
      .message = "scene.json:1:11: expected ':' behind the key" },
    { .what = "json no comma",
      .file = "scene.json",
      .text = "{\"bodies\":[{} {}]}",
      .code = SCENE_E_SYNTAX,
      .message = "scene.json:1:15: expected ',' or ']'" },
    { .what = "json no comma in an object",
      .file = "scene.json",
      .text = "{\"scene\":{\"dt\":0.1e \"y\":1}}",
      .code = SCENE_E_SYNTAX,
      .message = "scene.json:1:16: expected a value: a number, \"text\", true, false, [...] or {...}" },
    { .what = "json bad escape",
      .file = "scene.json",
      .text = "{\"a\":\"\\q\"}",
      .code = SCENE_E_SYNTAX,
      .message = "scene.json:1:7: a backslash must be followed by one of \"\\/bfnrtu" },
    { .what = "json half a pair",
      .file = "scene.json",
      .text = "{\"a\":\"\\ud834\\udd1e \\ud834\"}",
      .code = SCENE_E_SYNTAX,
      .message = "scene.json:1:20: half of a surrogate pair stands alone" },
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
      .message = "scene.json:1:28: 'time' must be a number from 0 to 1e9 [s]" },
};
// clang-format on

static void test_malformed_scripts(void **state)
{
    (void)state;
    check_malformed(table, (int)(sizeof table / sizeof *table));
    assert_true(sizeof table / sizeof *table >= 45);
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

// Two that touch in the first step, and a line.
#define TOUCHING                                                                                   \
    "body{ type = 'static', box{9, 1}, at = {0, -0.5} } body{ box{1, 1}, at = {0, 0.5} }\n"

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
        { "body{ name = 'box', box{1, 1} }\nat(0, function() local n = 1\n  find('bx'):destroy() "
          "end)",
          "scene.lua:3:3: there is no body 'bx' (did you mean 'box'?)" },
        { "body{ name = 'box', box{1, 1} }\nat(0, function()\n  local b = find('bx')\n  "
          "b:destroy() end)",
          "scene.lua:4:3: attempt to index a nil value (local 'b')" },
        { "local b = body{ box{1, 1} }\nrevolute{ b, at = {0, 0}, name = 'hinge' }\n"
          "at(0, function() find_joint('hing'):destroy() end)",
          "scene.lua:3:18: there is no joint 'hing' (did you mean 'hinge'?)" },
        { TOUCHING "on_contact(function(a, b, c) print(c.impulse, c.sped) end)",
          "scene.lua:2:49: a contact has no 'sped'; it has impulse nx ny speed time x y (did you "
          "mean 'speed'?)" },
        { TOUCHING "edit_contact(function(a, b, c) c.enabeld = false end)",
          "scene.lua:2:34: a contact has no 'enabeld'; it has enabled friction nx ny restitution "
          "rolling_resistance "
          "separation surface_speed touching x y (did you mean 'enabled'?)" },
        { "body{ box{1, 1} }\nat(0, function() return heat().burn end)",
          "scene.lua:2:32: heat() has no 'burn'; it has burning burnt carried content gone heating "
          "held mechanical melted "
          "owed radiated (did you mean 'burnt'?)" },
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

// What a test function returns in place of true or false, and numbers: an error with the line and the name.
static void test_verdicts(void **state)
{
    (void)state;
    static const char *const verdicts[][2] = {
        { "", "must return true or false first, not nothing (nil)" },
        { "return nil, 3", "must return true or false first, not nothing (nil)" },
        { "return 1", "must return true or false first, not a number" },
        { "return 'yes'", "must return true or false first, not a string" },
        { "return {}", "must return true or false first, not a table" },
        { "return print", "must return true or false first, not a function" },
        { "return find('b')", "must return true or false first, not a body" },
        { "return true, 'fast'",
          "must return a number as its second value, what was measured, not a string" },
        { "return true, false",
          "must return a number as its second value, what was measured, not false" },
        { "return false, {}, 1",
          "must return a number as its second value, what was measured, not a table" },
        { "return true, 1, '5'",
          "must return a number as its third value, the limit, not a string" },
    };
    for (size_t i = 0; i < sizeof verdicts / sizeof *verdicts; i++) {
        char text[256], message[256];
        snprintf(text, sizeof text,
                 "body{ name = 'b', box{1, 1} }\nexpect{ 'holds', at = 0.01,\n"
                 "  test = function() %s end }",
                 verdicts[i][0]);
        snprintf(message, sizeof message, "scene.lua:3:3: the function 'test' of 'holds' %s",
                 verdicts[i][1]);
        scene *s = load(text);
        scene_error e = { 0 };
        assert_int_equal(scene_step(s, &e), SCENE_E_TYPE);
        assert_string_equal(e.text, message);
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
    assert_string_equal(e.text, "/no/such/file.lua: cannot be opened: No such file or directory");
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
        cmocka_unit_test(test_malformed_scripts),
        cmocka_unit_test(test_handler_errors),
        cmocka_unit_test(test_verdicts),
        cmocka_unit_test(test_arguments),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
