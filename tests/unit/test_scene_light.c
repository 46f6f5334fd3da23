// test_scene_light.c - light{}: lamps, what is asked of them, what they refuse, the way through JSON.
#define _POSIX_C_SOURCE 200809L // open_memstream
#include "scene_fixture.h"

static const char lamps[] =
    "scene{ gravity = {0, 0}, duration = 2 }\n"
    "local mirror = material{ reflectance = 0.9 }\n"
    "local glass = material{ refractive_index = 1.5, absorption = 0.1 }\n"
    "body{ name = 'mirror', type = 'static', segment{ {3, -1}, {4, 1} }, material = mirror }\n"
    "body{ name = 'glass', type = 'static', box{1, 1}, material = glass }\n"
    "body{ name = 'wall', type = 'static', box{0.2, 6}, at = {-4, 0} }\n"
    "body{ name = 'wheel', type = 'kinematic', circle{0.3}, at = {0, 2}, spin = math.pi }\n"
    "local laser = light{ name = 'laser', at = {-3, 0.1}, power = 2, color = '#2060d0' }\n"
    "light{ name = 'beacon', body = 'wheel', at = {0.1, 0}, rays = 3, width = 0.2, spread = 0.1, "
    "polarization = -1, least = 0.02, bounces = 5, length = 30 }\n"
    "light{ name = 'off', hidden = true, around = 1.2, angle = 1, sensors = true }\n"
    "expect{ 'path', at = 0, test = function()\n"
    "  local p = light_path('laser')\n"
    "  return p[1].body == 'glass' and p[1].parent == 0 and p[1].how == 'sent' and p[2].how == "
    "'refracted' and p[2].parent == 1 and p[2].depth == 1 and math.abs(p[2].index - 1.5) < 1e-6 "
    "and "
    "math.abs(p[1].power - 2) < 1e-6 and math.abs(p[2].power - 1.92) < 1e-5 and p[1].incidence < "
    "1e-6 and "
    "math.abs(p[2].power_end - 1.92 * math.exp(-0.1)) < 1e-5 and p[1].absorbed == 0 and "
    "p[1].polarization == 0\n"
    "end }\n"
    "expect{ 'on the mirror', at = 0, test = function()\n"
    "  local kept, comes = light_on('mirror', 'laser')\n"
    "  return math.abs(kept - 0.1 * comes) < 1e-5 and math.abs(comes - 2 * 0.96^2 * "
    "math.exp(-0.1)) < 4e-3, comes\n"
    "end }\n"
    "expect{ 'all lamps', at = 0, test = function()\n"
    "  local a, b = light_on('wall'), light_on(find('wall'), 'laser') + light_on('wall', 'beacon') "
    "+ light_on('wall', 'off')\n"
    "  return a > 0 and math.abs(a - b) < 1e-9, a, b\n"
    "end }\n"
    "expect{ 'turns with the wheel', at = 1, test = function()\n"
    "  local p = light_path('beacon', 2)[1]\n"
    "  return math.abs(p.x0 + 0.1) < 1e-4 and p.body == 'wall' and p.x1 < -3.8 and p.polarization "
    "== -1, p.x1\n"
    "end }\n"
    "expect{ 'set', at = 2, test = function() return math.abs(light_path('laser')[1].power - 5) < "
    "1e-6 end }\n"
    "at(1.5, function() laser:set{ power = 5 } end)\n";

static void lamps_are_asked(void **state)
{
    (void)state;
    scene *s = load(lamps);
    assert_int_equal(scene_light_count(s), 3);
    const scene_light laser = scene_light_get(s, 0), beacon = scene_light_get(s, 1),
                      off = scene_light_get(s, 2);
    assert_string_equal(laser.name, "laser");
    assert_true(laser.rays == 1 && laser.power == 2 && laser.color.b == 0xd0 &&
                laser.palette == -1);
    assert_true(beacon.rays == 3 && beacon.power == 1 && beacon.color.a == 0 && off.rays == 0);
    plumb_light_segment path[16];
    plumb_light_sum sum;
    assert_true(scene_light_trace(s, 1, 2, path, 16, &sum) > 0);
    assert_true(fabs(sum.sent - 1.0 / 3) < 1e-6);
    assert_true(fabs(sum.sent - sum.absorbed - sum.left - sum.cut) < 1e-15);
    run_and_hold(s);
    scene_destroy(s);
}

// They shine as before, and pass with their bodies.
static void lamps_go_through_json(void **state)
{
    (void)state;
    scene *a = load(lamps);
    steps(a, 40);
    size_t size;
    char *json = export_json(a, &size);
    assert_non_null(strstr(json, "\"lights\":["));
    scene *b = load_as("test.json", json, size, NULL);
    char *again = export_json(b, &size);
    assert_string_equal(json, again);
    assert_int_equal(scene_light_count(b), 3);
    for (int i = 0; i < 3; ++i) {
        plumb_light_segment p[16], q[16];
        const int count = scene_light_trace(a, i, 0, p, 16, NULL);
        assert_int_equal(scene_light_trace(b, i, 0, q, 16, NULL), count);
        for (int k = 0; k < count; ++k) {
            assert_true(fabs((double)(p[k].to.x - q[k].to.x)) < 1e-3 &&
                        fabs((double)(p[k].to.y - q[k].to.y)) < 1e-3);
            assert_true(fabs((double)(p[k].power - q[k].power)) < 1e-5);
        }
    }
    free(again);
    free(json);
    scene_destroy(b);
    scene_destroy(a);
}

static void lamps_go_with_their_body(void **state)
{
    (void)state;
    scene *s =
        load("scene{ duration = 0.1 }\nbody{ name = 'b', circle{1} }\n"
             "body{ name = 'wall', type = 'static', box{1, 100}, at = {5, 0} }\n"
             "local l = light{ name = 'on', body = 'b' } local m = light{ name = 'm' }\n"
             "at(0.04, function() find('b'):destroy() m:remove() end)\n"
             "expect{ 'shines', at = 0.02, test = function() return light_on('wall') > 0.99 end }\n"
             "expect{ 'is gone', at = 0.08, test = function() return light_on('wall') == 0 and "
             "#light_path('on') == 0 end }\n");
    run_and_hold(s);
    assert_int_equal(scene_light_count(s), 1);
    assert_int_equal(scene_light_get(s, 0).rays, 0);
    size_t size;
    char *json = export_json(s, &size);
    assert_null(strstr(json, "lights"));
    free(json);
    scene_destroy(s);
}

static void mistakes_are_told(void **state)
{
    (void)state;
    static const char *const rows[][2] = {
        { "light{ at = 3 }", "'at'" },
        { "light{ agnle = 3 }", "did you mean 'angle'?" },
        { "light{ power = 0 }", "power" },
        { "light{ polarization = 2 }", "polarization" },
        { "light{ bounces = 200 }", "bounces" },
        { "light{ rays = 65 }", "rays" },
        { "light{ around = -1 }", "around" },
        { "light{ body = 'nobody' }", "nobody" },
        { "light{ body = 'b*' }", "must name one body" },
        { "light{ name = 'a' } light{ name = 'a' }", "two lights are called 'a'" },
        { "light{ length = 2e12 }", "length" },
        { "local l = light{ name = 'a' } light{ name = 'b' } l:set{ name = 'b' }",
          "two lights are called 'b'" },
        { "local l = light{} l:set{ power = -1 }", "power" },
        { "local l = light{} l:set(3)", "table expected" },
        { "local l = light{} l:remove() l:set{ power = 1 }", "was removed" },
        { "light(3)", "light" },
        { "light{ name = 'laser' } light_path('lasre')", "did you mean 'laser'?" },
        { "light{ name = 'a' } light_path('a', 2)", "rays 1 to 1" },
        { "light_path()", "string expected" },
        { "light_on('nobody')", "nobody" },
        { "body{ name = 'b', circle{1} } light_on('b', 'a')", "no light is called 'a'" },
        { "light_on()", "string expected" },
        { "material{ refractive_index = 11 }", "refractive_index" },
        { "material{ reflectance = 1.5 }", "reflectance" },
        { "material{ absorption = -1 }", "absorption" },
        { "material{ reflectence = 1 }", "did you mean 'reflectance'?" },
    };
    for (size_t i = 0; i < sizeof rows / sizeof *rows; ++i) {
        scene *s = NULL;
        scene_error e = { 0 };
        const char *text = rows[i][0];
        scene_load(&(scene_options){ .path = "test.lua", .text = text, .text_size = strlen(text) },
                   &s, &e);
        if (s != NULL || strstr(e.text, rows[i][1]) == NULL ||
            strstr(e.text, "test.lua:1") == NULL) {
            fail_msg("%s: %s", text, e.text);
        }
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(lamps_are_asked),
        cmocka_unit_test(lamps_go_through_json),
        cmocka_unit_test(lamps_go_with_their_body),
        cmocka_unit_test(mistakes_are_told),
    };
    return cmocka_run_group_tests_name("lamps of scenes", tests, NULL, NULL);
}
