// test_scene_fluids.c - water{} and wind{}: what they make, what they refuse, the way through JSON.
#define _POSIX_C_SOURCE 200809L // open_memstream
#include "scene_fixture.h"

static const char sea[] =
    "scene{ duration = 15 }\n"
    "local w = water{ name = 'sea', box{40, 4}, at = {0, -2}, density = 1025, flow = {1.5, 0}, "
    "drag = 0.7 }\n"
    "wind{ name = 'air', box{40, 10}, at = {0, 5}, flow = {3, 0}, gust = 0.2, gust_length = 3 }\n"
    "body{ name = 'box', box{1, 1}, density = 512.5, at = {-18, 0.1}, fixed_rotation = true }\n"
    "expect{ 'floats half', at = 15, body = 'box', y = {-0.01, 0.01} }\n"
    "expect{ 'drifts', at = 15, test = function() local v = find('box'):velocity() return v > 1.4 "
    "and v < 1.7, v, 1.5 end }\n";

static void words_make_a_material_and_a_body(void **state)
{
    (void)state;
    scene *s = load(sea);
    const char *const names[] = { "sea", "air" };
    for (int i = 0; i < 2; ++i) {
        plumb_world *w = scene_world(s);
        scene_body found = scene_body_get(s, i);
        plumb_shape shape;
        plumb_material_desc m;
        assert_string_equal(found.name, names[i]);
        assert_int_equal(plumb_body_shapes(w, found.entity, &shape, 1), 1);
        assert_true(plumb_shape_is_sensor(w, shape));
        assert_int_equal(plumb_material_settings(w, plumb_shape_material(w, shape), &m), PLUMB_OK);
        assert_true(m.fluid && m.weightless == (i == 1));
        assert_true(fabs((double)m.density - (i == 0 ? 1025 : 1.2)) < 1e-4);
        assert_true(fabs((double)m.flow_x - (i == 0 ? 1.5 : 3)) < 1e-4);
        assert_true(fabs((double)m.drag - (i == 0 ? 0.7 : 1.8)) < 1e-4);
        assert_true(found.hidden == (i == 1));
    }
    run_and_hold(s);
    scene_destroy(s);
}

// The same motion: gusts go on where they were.
static void json_keeps_fluids(void **state)
{
    (void)state;
    scene *a = load(sea);
    steps(a, 200);
    size_t size;
    char *json = export_json(a, &size);
    scene *b = load_as("test.json", json, size, NULL);
    for (int i = 0; i < 300; ++i) {
        steps(a, 1);
        steps(b, 1);
    }
    const plumb_vec2 p = plumb_body_position(scene_world(a), scene_body_get(a, 2).entity);
    const plumb_vec2 q = plumb_body_position(scene_world(b), scene_body_get(b, 2).entity);
    assert_true(p.x > -18 && fabs((double)(p.x - q.x)) < 1e-4 && fabs((double)(p.y - q.y)) < 1e-4);
    free(json);
    scene_destroy(a);
    scene_destroy(b);
}

static const char lake[] =
    "scene{ duration = 4 }\n"
    "water{ name = 'lake', box{30, 4}, at = {0, -2} }\n"
    "waves{ body = 'lake', modes = 32, swell = 0.2, swell_length = -8, damping = 0, state = {{0.1, "
    "0}, {0, 0.2}} }\n"
    "body{ name = 'box', box{1, 1}, density = 500, at = {-3, 1.5}, angle = 0.4 }\n"
    "expect{ 'asked', at = 0, test = function() local y, slope, rate = wave_at(-15) return "
    "math.abs(y - 0.3) < 1e-2, y, 0.3 end }\n"
    "expect{ 'of a body', at = 0, test = function() return wave_at(2, 'lake') == wave_at(2) and "
    "wave_at(2, 'sea') == nil end }\n";

static void waves_go_through_json(void **state)
{
    (void)state;
    scene *a = load(lake);
    plumb_shape shape;
    plumb_waves_desc d;
    int count;
    assert_int_equal(plumb_world_waves(scene_world(a), &shape, 1), 1);
    assert_int_equal(plumb_waves_settings(scene_world(a), shape, &d), PLUMB_OK);
    assert_true(d.modes == 32 && d.no_damping && d.damping == 0 && d.swell_length == -8);
    assert_true(plumb_waves_modes(scene_world(a), shape, &count)[1].rate == 0.2);
    steps(a, 70); // in mid splash
    size_t size;
    char *json = export_json(a, &size);
    scene *b = load_as("test.json", json, size, NULL);
    steps(a, 60);
    steps(b, 60);
    const plumb_vec2 p = plumb_body_position(scene_world(a), scene_body_get(a, 1).entity);
    const plumb_vec2 q = plumb_body_position(scene_world(b), scene_body_get(b, 1).entity);
    assert_true(fabs((double)(p.x - q.x)) < 1e-4 && fabs((double)(p.y - q.y)) < 1e-4);
    free(json);
    scene_destroy(b);
    scene_destroy(a);
    a = load(lake);
    run_and_hold(a);
    scene_destroy(a);
}

static void mistakes_are_told(void **state)
{
    (void)state;
    static const char *const rows[][2] = {
        { "water{ box{1, 1}, flow = 3 }", "'flow' of water{} must be {x, y}" },
        { "water{ box{1, 1}, flow = {1, 2, 3} }", "'flow' of water{} must be {x, y}" },
        { "water{ box{1, 1}, flow = {'fast', 0} }", "flow_x" },
        { "water{ box{1, 1}, drga = 1 }", "drga" },
        { "wind{ box{1, 1}, gust = -1 }", "gust" },
        { "wind{ flow = {1, 0} }", "shape" },
        { "wind{ box{1, 1}, eddies = -1 }", "eddies" },
        { "wind{ box{1, 1}, swril = 1 }", "did you mean 'swirl'?" },
        { "water{ box{1, 1}, flwo = {1, 0} }", "did you mean 'flow'?" },
        { "wind{ box{1, 1}, core_radius = 0 }", "core_radius" },
        { "fluid_at(1)", "number expected" },
        { "water(3)", "water" },
        { "waves{ modes = 3 }", "waves{} needs 'body'" },
        { "waves{ body = 'sea' }", "sea" },
        { "local w = water{ box{1, 1} } waves{ body = w, modes = 0 }", "modes" },
        { "local w = water{ box{1, 1} } waves{ body = w, modes = 2, state = {{0, 0}, {0, 0}, {1, "
          "0}} }",
          "waves{} has 2 modes" },
        { "local w = water{ box{1, 1} } waves{ body = w, state = {{0}} }", "two numbers" },
        { "local w = water{ box{1, 1} } waves{ body = w } waves{ body = w }", "has waves" },
        { "local w = water{ circle{1} } waves{ body = w }", "no polygon" },
        { "local w = wind{ box{1, 1} } waves{ body = w }", "weightless" },
        { "local w = body{ box{1, 1} } waves{ body = w }", "no sensor" },
        { "local w = water{ box{1, 1} } waves{ body = w, swel = 1 }", "did you mean 'swell'?" },
        { "wave_at('x')", "number expected" },
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

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(words_make_a_material_and_a_body),
        cmocka_unit_test(json_keeps_fluids),
        cmocka_unit_test(waves_go_through_json),
        cmocka_unit_test(mistakes_are_told),
    };
    return cmocka_run_group_tests_name("fluids of scenes", tests, NULL, NULL);
}
