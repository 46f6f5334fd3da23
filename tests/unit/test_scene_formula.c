// test_scene_formula.c - formula{}: what it does, what changes of it, JSON, and where a mistake in its text is told.
#define _POSIX_C_SOURCE 200809L // open_memstream
#include "scene_fixture.h"

static void test_motion(void **state)
{
    (void)state;
    scene *s = load(
        "scene{ gravity = {0, 0}, dt = 1/60, duration = 3, sleep = false }\n"
        "orbits{ order = 4 }\n"
        "local k = 4\n"
        "formula{ potential = '0.5 * ' .. k .. ' * r^2', at = {1, 0}, only = 'ball' }\n"
        "formula{ y = '-vy * hypot(vx, vy)', only = {'stone'} }\n"
        "formula{ x = '3 * cos(t)', on = 'charge' }\n"
        "body{ name = 'ball', circle{0.1, category = 'ball', collides = {}}, at = {2, 0} }\n"
        "body{ name = 'stone', circle{0.1, category = 'stone', collides = {}}, velocity = {0, 5} "
        "}\n"
        "body{ name = 'ion', circle{0.1, category = 'ion', collides = {}}, charge = 2, mass = 2 }\n"
        "exact{ 'well', body = 'ball', x = function(t) return 1 + math.cos(2 * t) end }\n"
        "exact{ 'drag', body = 'stone', y = function(t) return math.log(1 + 5 * t) end }\n"
        "exact{ 'field', body = 'ion', x = function(t) return 3 - 3 * math.cos(t) end }\n"
        "expect{ 'well', exact = 'well', tolerance = 1e-5 }\n"
        "expect{ 'drag', exact = 'drag', tolerance = 2e-5 }\n"
        "expect{ 'field', exact = 'field', tolerance = 1e-5 }\n");
    run_and_hold(s);
    scene_destroy(s);
}

static void test_methods(void **state)
{
    (void)state;
    scene *s =
        load("scene{ gravity = {0, 0}, duration = 2, sleep = false }\n"
             "local b = body{ name = 'b', box{1, 1} }\n"
             "local f = formula{ x = '1' }\n"
             "local g = formula{ potential = '-y', half = {5, 5}, angle = 0.1 }\n"
             "at(0.5, function() f:set{ x = '-1' } end)\n"
             "at(1, function() local vx, vy = b:velocity() score('half', vx) f:remove() g:set{ "
             "potential = 'y' } end)\n"
             "at(1.5, function() g:set{ half = {0, 0}, replace = true, priority = 2 } end)\n");
    run(s);
    assert_near(score(s, "half"), -0.1, 0.02);
    plumb_world *w = scene_world(s);
    plumb_law laws[2];
    assert_int_equal(plumb_world_laws(w, laws, 2), 1);
    plumb_law_desc d;
    plumb_law_settings(w, laws[0], &d);
    assert_string_equal(d.potential, "y");
    assert_true(d.combine == PLUMB_LAW_REPLACE && d.priority == 2 && d.half.x == 0);
    scene_destroy(s);
}

static void test_json(void **state)
{
    (void)state;
    scene *s =
        load("scene{ gravity = {0, 0}, duration = 2 }\n"
             "body{ name = 'wheel', type = 'kinematic', circle{1}, spin = 2 }\n"
             "body{ name = 'b', circle{0.1}, at = {2, 0} }\n"
             "formula{ body = 'wheel', x = '-4 * x - vx', y = ' sin( t ) ', angle = 0.5,\n"
             "    priority = 3 }\n"
             "formula{ potential = '(x^2 - 1)^2', at = {1, 2}, radius = 4, replace = true }\n");
    size_t size, again_size;
    char *text = export_json(s, &size);
    scene *copy = load_as("test.json", text, size, NULL);
    char *again = export_json(copy, &again_size);
    assert_true(size == again_size && memcmp(text, again, size) == 0);
    assert_non_null(strstr(text, "\"kind\":\"formula\""));
    assert_non_null(strstr(text, "\"y\":\" sin( t ) \""));
    run(s);
    run(copy);
    assert_true(plumb_world_hash(scene_world(s)) == plumb_world_hash(scene_world(copy)));
    free(text), free(again);
    scene_destroy(s), scene_destroy(copy);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_motion),
        cmocka_unit_test(test_methods),
        cmocka_unit_test(test_json),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
