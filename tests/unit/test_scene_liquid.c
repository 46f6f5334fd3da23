// test_scene_liquid.c - liquid{} and liquid_in(): what they fill and tell, what they refuse, the way through JSON.
#define _POSIX_C_SOURCE 200809L // open_memstream
#include "scene_fixture.h"

static const char tank[] =
    "scene{ duration = 1 }\n"
    "body{ type = 'static', box{6, 1, at = {0, -0.5}}, box{1, 8, at = {-2.5, 4}}, "
    "box{1, 8, at = {2.5, 4}} }\n"
    "body{ name = 'crate', box{0.6, 0.4}, density = 400, at = {0.3, 1.4}, angle = 0.2 }\n"
    "liquid{ spacing = 0.1, density = 900, viscosity = 2, tension = 3, friction = 0.25, color = "
    "'#804020', box{4, "
    "1, at = {0, "
    "0.5}} "
    "}\n"
    "liquid{ circle{0.3, at = {-1, 2}}, polygon{ {-0.2, 2}, {0.8, 2}, {0.3, 3} }, velocity = {1, "
    "-2} "
    "}\n"
    "local area, top, speed, x, y = liquid_in(-2, 0, 2, 1)\n"
    "print(string.format('%.2f %.2f %.2f %.2f %.2f', area, top, speed, math.abs(x), y))\n"
    "print(liquid_in(5, 5, 6, 6))\n"
    "expect{ 'it stays in the tank', at = 1, test = function() return liquid_in(-2, 0, 2, 8) == "
    "liquid_in(-9, -9, 9, 9) end }\n"
    "expect{ 'the crate floats', at = 1, body = 'crate', y = {0.9, 1.6} }\n";

static void words_fill_shapes(void **state)
{
    (void)state;
    scene *s = load(tank);
    plumb_liquid_desc d;
    assert_int_equal(plumb_liquid_settings(scene_world(s), &d), PLUMB_OK);
    assert_true(fabs((double)d.spacing - 0.1) < 1e-6 && d.density == 900 && d.viscosity == 2 &&
                d.tension == 3 && d.friction == (plumb_real)0.25);
    const scene_liquid looks = scene_get_liquid(s, 0);
    assert_true(looks.palette < 0 && looks.color.r == 0x80 && looks.color.a == 0xff);
    int count, moving = 0;
    const plumb_particle *p = plumb_liquid_particles(scene_world(s), &count);
    for (int i = 0; i < count; ++i) {
        moving += p[i].velocity.x == 1 && p[i].velocity.y == -2;
    }
    assert_int_equal(count - moving, 400);
    assert_in_range(moving, 28 + 50 - 8, 28 + 50 + 8); // pi 0.09 + 0.5 m^2
    run_and_hold(s);
    scene_destroy(s);
}

// The same motion, bit for bit, from the start and from the midst of it.
static void json_keeps_it(void **state)
{
    (void)state;
    for (int before = 0; before <= 20; before += 20) {
        scene *a = load(tank);
        steps(a, before);
        size_t size;
        char *json = export_json(a, &size);
        scene *b = load_as("test.json", json, size, NULL);
        steps(a, 40);
        steps(b, 40);
        int count, other;
        const plumb_particle *p = plumb_liquid_particles(scene_world(a), &count);
        const plumb_particle *q = plumb_liquid_particles(scene_world(b), &other);
        assert_int_equal(count, other);
        assert_true(before > 0 || memcmp(p, q, (size_t)count * sizeof *p) == 0);
        free(json);
        json = export_json(b, &size);
        assert_non_null(strstr(
            json,
            "\"liquid\":{\"color\":\"#804020\",\"density\":900,\"friction\":0.25,\"particles\":"));
        free(json);
        scene_destroy(a);
        scene_destroy(b);
    }
}

static void mistakes_are_told(void **state)
{
    (void)state;
    static const char *const rows[][2] = {
        { "liquid{ spacing = 0 }", "spacing" },
        { "liquid{ spacing = 1e-9 }", "spacing" },
        { "liquid{ density = -1 }", "density" },
        { "liquid{ viscosity = 0/0 }", "viscosity" },
        { "liquid{ tension = -1 }", "tension" },
        { "liquid{ velocty = {1, 0} }", "did you mean 'velocity'" },
        { "liquid{ capsule{1, 0.5} }", "takes circles, boxes, polygons and outlines" },
        { "liquid{ box{1, 1, round = 0.1} }", "without 'round'" },
        { "liquid{ spacing = 0.0001, box{100, 100} }", "particles" },
        { "liquid{ particles = {{1}} }", "must be 2, 4, 8, 10 or 12 numbers" },
        { "liquid{ particles = {{1, 2, 3, 'x'}} }", "must be 2, 4, 8, 10 or 12 numbers" },
        { "liquid{ particles = {{1, 2, 0, 0, 0, 0, 0, 0, -1, 0}} }",
          "must be 2, 4, 8, 10 or 12 numbers" },
        { "liquid{ particles = {{1, 2, 0, 0, 0, 0, 0, 0, 1, 0}} }", "phase is 1" },
        { "liquid{ phase = 'oil', box{1, 1} }", "has no phase 'oil'" },
        { "liquid{ phases = { {name = 'oil'} }, phase = 'oli', box{1, 1} }", "did you mean 'oil'" },
        { "liquid{ phases = { {density = 3} } }", "name" },
        { "liquid{ phases = { {name = 'oil', densty = 3} } }", "did you mean 'density'" },
        { "liquid{ phases = { {name = 'oil', density = 0.3} } }", "a thousandth" },
        { "liquid{ phases = { {name = 'oil'}, {name = 'oil'} } }", "already" },
        { "liquid{ phases = { {name = 'water'} } }", "already" },
        { "liquid{ phases = { 3 } }", "must be a table" },
        { "liquid{} liquid{ phases = { {name = 'oil'} } }", "were given on line 1" },
        { "liquid_change(1, 2, 3, 4, 'water', 'ice')", "has no phase 'ice'" },
        { "liquid_change(1, 2, 3, 4, 5)", "takes names of phases" },
        { "liquid_in(1, 2, 3, 4, 'oil')", "has no phase 'oil'" },
        { "liquid{ box{1, 1} } liquid_change(1, 2, 0, 3, 'water', 'water')",
          "takes a box x0 < x1" },
        { "liquid{ particles = {{1, 2, 3, 1e7}} }", "velocity" },
        { "liquid{ spacing = 0.1 } liquid{ spacing = 0.1 }", "were given on line 1" },
        { "liquid_in(1, 2, 3)", "liquid_in takes four numbers" },
        { "liquid_drain(1, 2, 3, 'x')", "liquid_drain takes four numbers" },
        { "liquid{ box{1, 1} } liquid_drain(1, 2, 0, 3)", "takes a box x0 < x1" },
        { "liquid{ refill = 3 }", "refill" },
        { "liquid{} liquid_at(1)", "liquid_at takes two numbers" },
        { "liquid{} liquid_ray(1, 2, 3)", "liquid_ray takes four numbers" },
        { "liquid_at(1, 2)", "liquid_at needs a liquid{}" },
        { "liquid_ray(1, 2, 3, 4)", "liquid_ray needs a liquid{}" },
        { "on_wet(3)", "on_wet takes a function or a table" },
        { "on_dry{ a = 'x' }", "on_dry" },
        { "liquid(3)", "liquid" },
        { "scene{ wrap_x = 10 } liquid{ }", "wraps around" },
    };
    for (size_t i = 0; i < sizeof rows / sizeof *rows; ++i) {
        scene *s = NULL;
        scene_error e = { 0 };
        const char *text = rows[i][0];
        scene_load(&(scene_options){ .path = "test.lua", .text = text, .text_size = strlen(text) },
                   &s, &e);
        assert_null(s);
        if (strstr(e.text, rows[i][1]) == NULL || strstr(e.text, "test.lua:1") == NULL) {
            fail_msg("%s: %s", text, e.text);
        }
    }
}

static const char splash[] =
    "scene{ duration = 2 }\n"
    "body{ type = 'static', box{6, 1, at = {0, -0.5}}, box{1, 4, at = {-1.5, 2}}, "
    "box{1, 4, at = {1.5, 2}} }\n"
    "liquid{ spacing = 0.1, box{2, 1, at = {0, 0.5}}, phases = { { name = 'oil', density = 800 } } "
    "}\n"
    "liquid{ phase = 'oil', box{2, 0.4, at = {0, 1.2}} }\n"
    "body{ name = 'duck', box{0.5, 0.4}, density = 300, at = {0, 2.5} }\n"
    "body{ name = 'dove', box{0.5, 0.4}, density = 300, at = {0, 20}, gravity_scale = 0 }\n"
    "local wet, dry, push = 0, 0, 0\n"
    "on_wet{ a = 'd*', function(b, e) wet = wet + 1; push = math.max(push, e.fy); "
    "assert(b:name() == 'duck') end }\n"
    "on_dry{ a = 'duck', function(b) dry = dry + 1; assert(not b:alive()) end }\n"
    "at(1.5, function() assert(dry == 0) find('duck'):destroy() end)\n"
    "local fill, vx, vy, what = liquid_at(0, 1.1)\n"
    "local none, _, _, no = liquid_at(0, 3)\n"
    "local x, y, nx, ny = liquid_ray(0.2, 3, 0.2, 0)\n"
    "assert(math.abs(fill - 1) < 1e-4 and vx == 0 and vy == 0 and what == 'oil')\n"
    "assert(none == 0 and no == nil and liquid_ray(0.2, 3, 0.2, 2) == nil)\n"
    "assert(math.abs(x - 0.2) < 1e-6 and math.abs(y - 1.4) < 1e-3 and math.abs(nx) < 1e-3 and ny > "
    "0.999)\n"
    "expect{ 'wet once, and dry when it is gone', at = 2, test = function() "
    "return wet == 1 and dry == 1 and push > 0, wet + dry, 2 end }\n";

// What is where, and whom it touches.
static void questions_and_handlers_tell(void **state)
{
    (void)state;
    scene *s = load(splash);
    run_and_hold(s);
    scene_destroy(s);
}

static const char layers[] =
    "scene{ duration = 1 }\n"
    "body{ type = 'static', box{6, 1, at = {0, -0.5}}, box{1, 4, at = {-1.5, 2}}, "
    "box{1, 4, at = {1.5, 2}} }\n"
    "liquid{ spacing = 0.1, name = 'brine', density = 1100, phases = { "
    "{ name = 'oil', density = 800, viscosity = 0.1, color = '#e0b040' }, { name = 'ink' } }, "
    "box{2, 1, at = {0, 0.5}} }\n"
    "liquid{ phase = 'oil', box{2, 0.4, at = {0, 1.2}} }\n"
    "liquid{ dye = '#204060', box{0.4, 0.2, at = {0, 1.7}} }\n"
    "local inked = liquid_change(-1, 0, 0, 0.4, 'brine', 'ink')\n"
    "expect{ 'inked', at = 0, test = function() return math.abs(inked - 0.4) < 1e-5, inked, 0.4 "
    "end }\n"
    "expect{ 'oil', at = 1, test = function() local a = liquid_in(-9, -9, 9, 9, 'oil') "
    "return math.abs(a - 0.8) < 1e-5, a, 0.8 end }\n"
    "expect{ 'all', at = 1, test = function() local a = liquid_in(-9, -9, 9, 9) "
    "return math.abs(a - 2.88) < 1e-5, a, 2.88 end }\n";

// By name in the language and by number in the library; through JSON with dye, and on the same way from there.
static void phases_have_names(void **state)
{
    (void)state;
    scene *s = load(layers);
    int count;
    const plumb_liquid_phase *p = plumb_liquid_phases(scene_world(s), &count);
    assert_int_equal(count, 2);
    assert_true(p[0].density == 800 && p[1].density == 1000);
    assert_int_equal(scene_get_liquid(s, 1).color.r, 0xe0);
    assert_true(scene_get_liquid(s, 2).color.a == 0);
    size_t size;
    char *json = export_json(s, &size);
    assert_non_null(strstr(json, "\"phases\":["));
    scene *b = load_as("test.json", json, size, NULL);
    free(json);
    int dyed = 0;
    const plumb_particle *q = plumb_liquid_particles(scene_world(b), &count);
    for (int i = 0; i < count; ++i) {
        dyed += q[i].tag == 0xff204060u;
    }
    assert_int_equal(dyed, 8);
    steps(s, 30);
    steps(b, 30);
    int other;
    const plumb_particle *from = plumb_liquid_particles(scene_world(s), &other);
    q = plumb_liquid_particles(scene_world(b), &count);
    assert_int_equal(count, other);
    assert_memory_equal(from, q, (size_t)count * sizeof *q);
    scene_destroy(b);
    run_and_hold(s);
    scene_destroy(s);
}

// A jet that ends in a drain: what is poured is there, or has gone.
static void sources_and_drains(void **state)
{
    (void)state;
    scene *s =
        load("scene{ duration = 1, gravity = {0, 0} }\n"
             "local gone = 0\n"
             "every_step(function()\n"
             "  liquid{ box{0.2, 0.4, at = {0.1, 0.2}}, velocity = {3, 0}, refill = true }\n"
             "  gone = gone + liquid_drain(1, -1e300, 1e300, 2)\n"
             "end)\n"
             "expect{ 'poured', at = 1, test = function() return gone + liquid_in(-9, -9, 9, "
             "9) > 1.1 end }\n"
             "expect{ 'drained', at = 1, test = function() return gone > 0.6 and "
             "liquid_in(1.1, -9, 99, 9) == 0 end }\n");
    run_and_hold(s);
    scene_destroy(s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(questions_and_handlers_tell),
        cmocka_unit_test(words_fill_shapes),
        cmocka_unit_test(json_keeps_it),
        cmocka_unit_test(mistakes_are_told),
        cmocka_unit_test(phases_have_names),
        cmocka_unit_test(sources_and_drains),
    };
    return cmocka_run_group_tests_name("liquid of scenes", tests, NULL, NULL);
}
