// test_scene_hostile.c - scripts that mean to run for ever. Each of the pieces of work below is done again and again
// in a scene's text and in a handler; each script must end with an error, within two seconds of processor time, by the
// limit of instructions, by the limit of time, or because the caller asks it to stop. Most do their work in C, where
// Lua's own hook counts one instruction for it.
// PLUMB_FLOAT_ONLY: what limits a script does not know the precision of the world.
// Set HOSTILE_PRINT=1 to see what each one took.
#define _POSIX_C_SOURCE 200809L // clock_gettime

#include "unit/scene_fixture.h"

#include <time.h>

static const uint64_t INSTRUCTIONS = 1000000; // of a handler; of a scene four times as many
static const double SECONDS = 0.01; // [s] of processor time, of handlers where time is the limit
static const double LONGEST =
    0.05; // [s] else: what one instruction of Lua does alone has no other limit
static const double STOP_AFTER = 0.005; // [s] of processor time
#ifdef __SANITIZE_ADDRESS__
static const double SLACK = 10; // [s] of processor time
#else
static const double SLACK = 2; // [s] of processor time
#endif

// What is made once, and what is then done for ever.
static const struct work {
    const char *setup, *again;
} works[] = {
    // Lua itself
    { "", "" },
    { "local x = 0", "x = x + 1" },
    { "local t = {}", "t[#t + 1] = {}" },
    { "local s = 'x'", "s = s .. s" },
    { "local s = ('x'):rep(60000)", "local r = s .. 'y'" },
    { "local function f(...) return ... end", "f(f(f(1, 2, 3)))" },
    { "local function f(n) if n > 0 then return f(n - 1) end end", "f(1000000000)" },
    { "local function f() return 1 + f() end", "f()" },
    { "local function f(n) if n > 1 then return f(n - 1) + f(n - 2) end return 1 end", "f(60)" },
    { "local function g() return g end", "g()()()" },
    { "", "for i = 1, math.maxinteger do end" },
    { "", "for i = 1, 2, 1e-300 do end" },
    { "", "for i = 1.0, 1e300 do end" },
    { "", "repeat until false" },
    { "", "local t = {1, 2, 3, 4, 5, 6, 7, 8}" },
    { "", "local f = function() return f end" },
    { "local t = {} t.t = t", "t = t.t" },
    { "local t = {} for i = 1, 100000 do t[i] = i end", "local n = #t" },
    { "local a, b = ('\\0'):rep(65000), ('\\0'):rep(64999)", "local c = a < b" },
    { "local a, b = ('\\0'):rep(65000), ('\\0'):rep(64999)", "local c = a <= b" },
    { "local a, b = ('x'):rep(65000) .. 'a', ('x'):rep(65000) .. 'b'", "local c = a < b" },
    { "local a, b = ('x'):rep(65000) .. 'a', ('x'):rep(65000) .. 'b'", "local c = a == b" },
    { "local a = ('0'):rep(60000)", "local c = a + 1" },
    { "local a = ('0'):rep(60000)", "local c = -a" },
    { "local a = ('0'):rep(60000)", "local c = a * a // 7 % 3" },
    { "local a = ('0'):rep(60000)", "local c = a | 1" },
    { "local a = ('0'):rep(60000)", "local c = math.floor(a)" },
    { "local a = ('0'):rep(60000)", "local c = math.sin(a)" },
    { "local a = ('0'):rep(60000)", "local c = math.max(a, a, a)" },
    { "local t = {} for i = 1, 3000 do t[i * 67108863] = i end", "local x = t[3001 * 67108863]" },
    // functions of libraries
    { "local t = {} for i = 1, 100000 do t[i] = '' end", "local s = table.concat(t)" },
    { "local t = {} for i = 1, 9000 do t[i] = i end", "local s = table.concat(t, ',')" },
    { "local t = {} for i = 1, 9000 do t[i] = i end", "local n = select('#', table.unpack(t))" },
    { "local t = {} for i = 1, 9000 do t[i] = i end", "local n = select(-1, table.unpack(t))" },
    { "local t = {} for i = 1, 9000 do t[i] = i end", "local u = table.pack(table.unpack(t))" },
    { "local t = {} for i = 1, 9000 do t[i] = i end", "local u = {table.unpack(t)}" },
    { "local t = {} for i = 1, 9000 do t[i] = i end", "math.max(table.unpack(t))" },
    { "local t = {} for i = 1, 9000 do t[i] = 65 end", "string.char(table.unpack(t))" },
    { "local t = {} for i = 1, 9000 do t[i] = i end local function f(...) while true do "
      "math.min(...) end end",
      "f(table.unpack(t))" },
    { "local t = {} for i = 1, 9000 do t[i] = i end local function g() end "
      "local function f(...) while true do g(...) end end",
      "f(table.unpack(t))" },
    { "local t = {} for i = 1, 100000 do t[i] = i end", "table.unpack(t)" },
    { "local t = {} for i = 1, 100000 do t[i] = i end", "for k, v in pairs(t) do break end" },
    { "local t = {} for i = 1, 100000 do t[i] = i end", "for k, v in ipairs(t) do end" },
    { "local t = {} for i = 1, 100000 do t['x' .. i] = i end for k in pairs(t) do t[k] = nil end",
      "pairs(t)" },
    { "local t = {} for i = 1, 20000 do t[i] = 0 end", "table.insert(t, 1, 0)" },
    { "local t = {} for i = 1, 20000 do t[i] = 0 end", "table.remove(t, 1) t[#t + 1] = 0" },
    { "local t = {} for i = 1, 20000 do t[i] = -i end", "table.sort(t)" },
    { "local t = {} for i = 1, 2000 do t[i] = i end", "table.sort(t, function() return true end)" },
    { "local t = {} for i = 1, 500 do t[i] = ('x'):rep(60000) .. i end", "table.sort(t)" },
    { "local a, b = ('a'):rep(65000), ('a'):rep(30000) .. 'b'", "a:find(b)" },
    { "local a = ('a'):rep(65000)", "a:find('b')" },
    { "local a = ('a'):rep(65000)", "a:find('ab')" },
    { "local a = ('a'):rep(65000)", "a:find('', 65000)" },
    { "local a = ('a'):rep(65000)", "a:find(a, 1, true)" },
    { "local a = ('a'):rep(65000)", "local u = a:upper()" },
    { "local a = ('a'):rep(65000)", "local u = a:lower()" },
    { "local a = ('a'):rep(65000)", "local u = a:reverse()" },
    { "local a = ('a'):rep(65000)", "local u = a:sub(2)" },
    { "local a = ('a'):rep(65000)", "local u = a:byte(1, -1)" },
    { "", "local s = ('x'):rep(65000)" },
    { "", "local s = (''):rep(1e15)" },
    { "", "local s = ('x'):rep(10000, 'yyy')" },
    { "local f = ('%99d'):rep(600) local t = {} for i = 1, 600 do t[i] = i end",
      "string.format(f, table.unpack(t))" },
    { "local f = ('%%'):rep(30000)", "string.format(f)" },
    { "", "string.format('%.99f', 1e300)" },
    { "local a = ('a'):rep(60000)", "string.format('%s', a)" },
    { "local a = ('\"'):rep(16000)", "string.format('%q', a)" },
    { "local a = ('0'):rep(60000)", "tonumber(a)" },
    { "local a = ('z'):rep(60000)", "tonumber(a, 36)" },
    { "local a = (' '):rep(60000)", "tonumber(a)" },
    { "", "tostring(1.5)" },
    { "local a = ('0'):rep(60000)", "print(a)" },
    { "", "print()" },
    { "", "math.sin(1e300) math.tan(-1e300) math.exp(700) math.log(1e-300)" },
    { "", "math.pow(1.0000001, 1023) math.pow(2, 0.5)" },
    { "", "math.fmod(1e308, 3e-308)" },
    { "", "random() random_int(1, 6)" },
    // objects and the world
    { "", "box{1, 1}" },
    { "local p = {} for i = 0, 127 do p[i + 1] = {i, i % 2 * 10} p[256 - i] = {i, i % 2 * 10 - "
      "0.5} "
      "end",
      "body{ type = 'static', outline(p) }" },
    { "local p = {} for i = 1, 20000 do p[i] = {i, i % 2} end", "chain(p)" },
    { "", "body{ circle{1}, at = {random(0, 1000), 0} }" },
    { "", "body{ type = 'static', box{1, 1} }:destroy()" },
    { "local i = 0", "i = i + 1 score('s' .. i, i)" },
    { "local i = 0", "i = i + 1 material{ name = 'm' .. i }" },
    { "local a, b = find('b1'), find('b2')", "exclude(a, b) exclude(a, b, false)" },
    { "local t = {} for i = 1, 20000 do t[i] = 'default' end", "box{1, 1, collides = t}" },
    { "local c = circle{1} local t = {} for i = 1, 2000 do t[i] = c end", "body(t):destroy()" },
    { "", "ray{ {-100, 1}, {100, 1} }" },
    { "", "cast{ circle{1}, from = {-100, 1}, to = {100, 1} }" },
    { "", "nearest{ {500, 500} }" },
    { "", "inside{ {0, 1} }" },
    { "light{ name = 'a', at = {-100, 1} }", "light_path('a')" },
    { "light{ name = 'a', at = {-100, 1}, rays = 64, width = 3 }", "light_on('b1')" },
    { "local l = light{ at = {-100, 1} }", "l:set{ power = 2 } light{}:remove()" },
    { "local p = '0' for i = 1, 24 do p = p .. '-exp(-(x-' .. i .. ')^2-y^2)' end local f = "
      "formula{ potential = p }",
      "f:set{ potential = p .. '+0' } f:set{ potential = p }" },
    { "local p = '1e-300' for i = 1, 50 do p = p .. '+' .. i .. 'e-300' end local f = formula{ x = "
      "p }",
      "f:set{ x = p .. '+0' } f:set{ x = p }" },
    { "", "formula{ x = 'sin(t)' }:remove()" },
    { "", "blast{ at = {0, 0}, radius = 100, impulse = 1e-6 }" },
    { "", "blast{ at = {0, 0}, radius = 100, impulse = 1e-6, occlusion = 'walls' }" },
    { "", "blast{ at = {0, 0}, radius = 100, impulse = 1e-6, occlusion = 'all' }" },
    { "", "energy() momentum() penetration() body_count() time()" },
    { "", "set_gravity(0, -9)" },
    { "", "split_step(16000)" },
    { "", "find('b1') find('nobody')" },
    { "local b = find('b1')", "b:overlaps()" },
    { "local b = find('b1')", "b:position() b:velocity() b:set_velocity(0, 0)" },
    { "local b = find('b1')", "b:teleport(0, 5) b:wake() b:sleep()" },
    { "local b = find('b1')", "b:set_type('static') b:set_type('dynamic')" },
    { "local b = find('b1')", "b:set_enabled(false) b:set_enabled(true)" },
    { "local b = find('b1')", "b:set_filter{ collides = {} }" },
    { "local b = find('b1')", "b:apply_impulse(0, 0.001) b:apply_force(0, 1)" },
    { "", "revolute{ find('b1'), find('b2') }:destroy()" },
    { "", "every_step(function() end)" },
    { "", "on_hit(function() end)" },
    { "", "at(0, function() end) every(1e-9, function() end)" },
    { "", "on_contact{ a = 'b*', function() end }" },
};
enum { WORKS = (int)(sizeof works / sizeof *works) };

// Handlers that are called, each with a budget of its own, so often that a step would never end.
static const char *const crowds[] = {
    "for i = 1, 20000 do every_step(function() for k = 1, 90000 do end end) end",
    "for i = 1, 20000 do at(0, function() local s = ('x'):rep(60000) end) end "
    "for i = 1, 20000 do every_step(function() for k = 1, 90000 do end end) end",
    "for i = 1, 5000 do expect{ 'e' .. i, always = true, test = function() "
    "for k = 1, 90000 do end return true end } end",
    "for i = 1, 5000 do on_contact(function() for k = 1, 90000 do end end) end",
    "edit_contact(function() for k = 1, 100000 do end end)",
    "field{ body = 'b*', function() for k = 1, 100000 do end end }",
};
enum { CROWDS = (int)(sizeof crowds / sizeof *crowds) };

static const char world[] =
    "scene{ duration = 1e6 }\n"
    "body{ name = 'ground', type = 'static', box{200, 1}, at = {0, -0.5} }\n"
    "body{ name = 'sensor', type = 'static', sensor = true, box{200, 1}, at = {0, 0.5} }\n"
    "for i = 1, 200 do body{ name = 'b' .. i, sensor = i == 1, mass = 1, circle{0.5}, "
    "at = {i % 20, 0.49 + i // 20} } end\n";

static double cpu_now(void)
{
    struct timespec t;
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

static void be_silent(void *context, const char *line)
{
    (void)context, (void)line;
}

static bool stop_soon(void *context)
{
    const double *at = context;
    return cpu_now() > *at;
}

enum { BY_WORK, BY_TIME, BY_STOP, WAYS };

// Loads and runs a text until it ends with an error. What limits it is `way`; the others are far away.
static void expect_end(const char *name, const char *text, int way)
{
    static const char *const ways[] = { "work", "time", "stop" };
    const uint64_t far = UINT64_MAX / 1000;
    double begin = cpu_now(), stop_at = HUGE_VAL;
    scene_options options = { .path = "hostile.lua",
                              .text = text,
                              .text_size = strlen(text),
                              .build_instructions = 4 * INSTRUCTIONS,
                              .handler_instructions = way == BY_WORK ? INSTRUCTIONS : far,
                              .build_seconds = LONGEST,
                              .handler_seconds = way == BY_TIME ? SECONDS : LONGEST,
                              .stop = stop_soon,
                              .stop_context = &stop_at,
                              .print = be_silent };
    scene *s;
    scene_error e = { 0 };
    scene_load(&options, &s, &e);
    for (int i = 0; i < 10000 && e.code == SCENE_OK; i++) {
        begin = cpu_now();
        stop_at = way == BY_STOP ? begin + STOP_AFTER : HUGE_VAL;
        scene_step(s, &e);
    }
    double took = cpu_now() - begin;
    if (getenv("HOSTILE_PRINT") != NULL) {
        printf("%-5s %6.3f s  %-60.60s  %s\n", ways[way], took, e.message, name);
        fflush(stdout);
    }
    bool known = e.code == SCENE_E_LIMIT || e.code == SCENE_E_STOPPED || e.code == SCENE_E_RUNTIME;
    if (!known || took > SLACK) {
        fail_msg("%s, by %s: code %d (%s) after %.2f s", name, ways[way], e.code, e.text, took);
    }
    scene_destroy(s);
}

static void scripts_that_never_end_do(void **state)
{
    (void)state;
    static char text[4096];
    for (int i = 0; i < WORKS; i++) {
        const struct work *w = &works[i];
        snprintf(text, sizeof text, "%s%s\nwhile true do %s end\n", world, w->setup, w->again);
        expect_end(w->again, text, BY_WORK);
        for (int way = 0; way < WAYS; way++) {
            snprintf(text, sizeof text, "%s%s\nat(0.01, function() while true do %s end end)\n",
                     world, w->setup, w->again);
            expect_end(w->again, text, way);
        }
    }
    printf("%d scripts\n", 2 * WORKS + CROWDS);
}

static void handlers_without_end_do(void **state)
{
    (void)state;
    static char text[4096];
    for (int i = 0; i < CROWDS; i++) {
        for (int way = 0; way < WAYS; way++) {
            snprintf(text, sizeof text, "%s%s\n", world, crowds[i]);
            expect_end(crowds[i], text, way);
        }
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(scripts_that_never_end_do),
        cmocka_unit_test(handlers_without_end_do),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
