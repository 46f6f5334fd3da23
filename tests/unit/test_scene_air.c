// test_scene_air.c - air{}, air_source{} and what asks them: what they make and tell, what they refuse, the way through JSON.
#define _POSIX_C_SOURCE 200809L // open_memstream
#include "scene_fixture.h"

static const char room[] =
    "scene{ duration = 1 }\n"
    "body{ type = 'static', box{6, 1, at = {0, -0.5}} }\n"
    "body{ name = 'fan', type = 'kinematic', circle{0.1}, at = {0.8, 1} }\n"
    "air{ size = {4, 2}, at = {0, 1}, cell = 0.125, density = 2, viscosity = 0.01, temperature = "
    "300, "
    "bottom = 'closed', left = 'flow', flow = {0.5, 0}, fading = 0.1, cooling = 0.2, color = "
    "'#804020' }\n"
    "local s = air_source{ at = {0, 0.3}, radius = 0.25, smoke = 3, heat = 90 }\n"
    "air_source{ body = 'fan', radius = 0.3, push = {6, 0} }\n"
    "air_fill(function(x, y) return nil, nil, y > 1 and 1 or nil, 10 end)\n"
    "local vx, vy, smoke, heat = air_at(0, 1.5)\n"
    "print(string.format('%.2f %.2f %.2f %.2f', vx, vy, smoke, heat))\n"
    "print(string.format('%.2f %.1f', air_sum()))\n"
    "at(0.5, function() s:set{ heat = 200 } end)\n"
    "expect{ 'it is fed and blown', at = 1, test = function()\n"
    "  local vx, _, smoke = air_at(0.8, 1)\n"
    "  local _, _, low = air_at(0, 0.4)\n"
    "  return vx > 0.6 and low > 0.3 end }\n";

static void words_make_it(void **state)
{
    (void)state;
    scene *s = load(room);
    plumb_air_desc d;
    assert_int_equal(plumb_air_settings(scene_world(s), &d), PLUMB_OK);
    assert_true(d.half.x == 2 && d.half.y == 1 && d.density == 2 && d.temperature == 300);
    assert_true(d.bottom == PLUMB_AIR_CLOSED && d.left == PLUMB_AIR_FLOW &&
                d.top == PLUMB_AIR_OPEN && d.flow.x == 0.5F);
    const scene_air looks = scene_get_air(s);
    assert_true(looks.palette < 0 && looks.color.r == 0x80 && looks.color.a == 0xff);
    int count;
    const plumb_air_source *sources = plumb_air_sources(scene_world(s), &count);
    assert_int_equal(count, 2);
    assert_true(sources[0].heat == 90 && sources[1].push.x == 6 && !plumb_is_null(sources[1].body));
    const plumb_air_sample a = plumb_air_at(scene_world(s), plumb_v2(0, 1.5F));
    assert_true(a.smoke == 1 && a.heat == 10 && a.velocity.x == 0);
    run_and_hold(s);
    assert_true(plumb_air_sources(scene_world(s), NULL)[0].heat == 200);
    scene_destroy(s);
}

// The same motion, bit for bit, from the start; from the midst of it, where bodies have rounded angles, all that is said.
static void json_keeps_it(void **state)
{
    (void)state;
    for (int before = 0; before <= 20; before += 20) {
        scene *a = load(room);
        steps(a, before);
        size_t size;
        char *json = export_json(a, &size);
        scene *b = load_as("test.json", json, size, NULL);
        steps(a, 5);
        steps(b, 5);
        plumb_air_box p, q;
        assert_int_equal(plumb_air_cells(scene_world(a), &p), PLUMB_OK);
        assert_int_equal(plumb_air_cells(scene_world(b), &q), PLUMB_OK);
        assert_int_equal(p.columns, q.columns);
        assert_true(before > 0 || memcmp(p.at, q.at, 33 * 17 * sizeof *p.at) == 0);
        int count;
        assert_true(plumb_air_sources(scene_world(b), &count)[0].heat == 90);
        assert_int_equal(count, 2);
        free(json);
        json = export_json(b, &size);
        assert_non_null(
            strstr(json, "{\"air\":{\"at\":[0,1],\"bottom\":\"closed\",\"cell\":0.125,\"cells\":"));
        assert_non_null(strstr(json, "\"sources\":["));
        free(json);
        scene_destroy(a);
        scene_destroy(b);
    }
}

static void mistakes_are_told(void **state)
{
    (void)state;
    static const char *const rows[][2] = {
        { "air{ }", "size" },
        { "air{ size = {0, 1} }", "size" },
        { "air{ size = {1, 1}, cell = 0 }", "cell" },
        { "air{ size = {1000, 1000}, cell = 0.01 }", "cells" },
        { "air{ size = {1, 1}, left = 'shut' }", "left" },
        { "air{ size = {1, 1}, left = 'periodic' }", "both must be periodic" },
        { "air{ size = {1, 1}, viscosty = 1 }", "did you mean 'viscosity'" },
        { "air{ size = {1, 1} } air{ size = {1, 1} }", "has air since line 1" },
        { "air{ size = {1, 1}, cells = {{1, 2}} }", "must have as many" },
        { "air{ size = {1, 1}, cell = 1, cells = {{0, 0, 0, 0, 0}, {1}, {}, {}} }",
          "must be five numbers" },
        { "air{ size = {1, 1}, cell = 1, cells = {{0, 0, -1, 0, 0}, {0,0,0,0,0}, {0,0,0,0,0}, "
          "{0,0,0,0,0}} }",
          "smoke" },
        { "air_source{ radius = 1 }", "no air" },
        { "air{ size = {1, 1} } air_source{ smoke = 1 }", "needs 'radius'" },
        { "air{ size = {1, 1} } air_source{ radius = 1, body = 'who' }", "who" },
        { "air{ size = {1, 1} } air_source{ radius = 1, heat = 1/0 }", "heat" },
        { "air{ size = {1, 1} } local s = air_source{ radius = 1 } s:remove() s:set{ heat = 1 }",
          "was removed" },
        { "air_at(0, 0, 0, 'x') air_at('x')", "number" },
        { "air_sum()", "no air" },
        { "air_fill(3)", "function" },
        { "air{ size = {1, 1} } air_fill(function() return 'x' end)", "number" },
        { "air(3)", "air" },
        { "scene{ wrap_x = 10 } air{ size = {1, 1} }", "wraps around" },
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
        cmocka_unit_test(words_make_it),
        cmocka_unit_test(json_keeps_it),
        cmocka_unit_test(mistakes_are_told),
    };
    return cmocka_run_group_tests_name("air of scenes", tests, NULL, NULL);
}
