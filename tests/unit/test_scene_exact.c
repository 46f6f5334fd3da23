// test_scene_exact.c - exact{}: what a scene says of the truth, how far the world is from it, and expect{} lines about it.
#define _POSIX_C_SOURCE 200809L // open_memstream
#include "scene_fixture.h"

static void test_exact(void **state)
{
    (void)state;
    scene *s = load("body{ name = 'b', circle{1} }\n"
                    "exact{ body = 'b', y = function(t) return -9.81 * t^2 / 2 end, vy = "
                    "function(t) return -9.81 * t end,"
                    " till = 2 }");
    assert_int_equal(scene_exact_count(s), 1);
    scene_exact x = scene_exact_get(s, 0);
    assert_string_equal(x.body, "b");
    assert_int_equal(x.given, 1u << SCENE_EXACT_Y | 1u << SCENE_EXACT_VY);
    assert_near(x.till, 2, 0);
    double v[SCENE_EXACT_COUNT];
    scene_error e;
    assert_int_equal(scene_exact_eval(s, 0, 2.0, v, &e), SCENE_OK);
    assert_near(v[SCENE_EXACT_Y], -19.62, 1e-12);
    assert_true(isnan(v[SCENE_EXACT_X]));
    scene_destroy(s);
}

// Errors of forms after 1 s, by kind: place, angle, velocity, spin, what the script measures, over a scale.
static void test_exact_errors(void **state)
{
    (void)state;
    static const struct {
        const char *form, *unit;
        double error;
    } rows[] = {
        { "body = 'b', x = function(t) return 2 * t - 3 end, y = function() return 4 end, "
          "spin = function() return 9 end",
          "m", 5 },
        { "body = 'b', angle = function(t) return t + 6.283185307179586 + 0.5 end, "
          "vx = function() return 7 end",
          "rad", 0.5 },
        { "body = 'b', vx = function() return 5 end, vy = function() return 4 end", "m/s", 5 },
        { "body = 'b', spin = function() return 3 end", "rad/s", 2 },
        { "measure = function(t) return 10 * t end, value = function() return 4 end, unit = 'N'",
          "N", 6 },
        { "measure = function(t) return 10 * t end, value = function() return 4 end", "1", 6 },
        { "measure = function(t) return 10 * t end, value = function() return 4 end, unit = 'N', "
          "scale = 4",
          "1", 1.5 },
        { "body = 'b', x = function() return 0 end, till = 0.5", "m", -1 },
        { "body = 'b', x = function() return 0 end, from = 1.5", "m", -1 },
        { "body = 'b', x = function() return 0 end, at = 1.005", "m", 2 }, // the nearest step
        { "body = 'b', x = function() return 0 end, at = 1.02", "m", -1 },
    };
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        char text[512];
        snprintf(text, sizeof text,
                 "scene{ gravity = {0, 0}, dt = 1/64, duration = 2 }\n"
                 "body{ name = 'b', circle{1}, velocity = {2, 0}, spin = 1 }\nexact{ %s }",
                 rows[i].form);
        scene *s = load(text);
        scene_error e;
        double error;
        for (int k = 0; k < 64; k++) {
            assert_int_equal(scene_step(s, &e), SCENE_OK);
        }
        assert_string_equal(scene_exact_get(s, 0).unit, rows[i].unit);
        assert_int_equal(scene_exact_error(s, 0, &error, &e), SCENE_OK);
        assert_near(error, rows[i].error, ROUNDED(1e-5));
        scene_destroy(s);
    }
}

// A line looks whenever its form says something, and tells the largest error, not the first beyond the limit.
static void test_expected_exact(void **state)
{
    (void)state;
    scene *s = load("scene{ gravity = {0, 0}, dt = 1/64, duration = 2 }\n"
                    "body{ name = 'b', circle{1}, velocity = {2, 0} }\n"
                    "exact{ 'stands', body = 'b', x = function() return 0 end, till = 1 }\n"
                    "exact{ 'later', measure = function() return 1 end, "
                    "value = function() return 0 end, from = 5 }\n"
                    "expect{ 'good', exact = 'stands', tolerance = 2.01 }\n"
                    "expect{ 'bad', exact = 'stands', tolerance = 0.5 }\n"
                    "expect{ 'early', exact = 'stands', tolerance = 1.01, till = 0.5 }\n"
                    "expect{ 'never', exact = 'later', tolerance = 2 }\n");
    run(s);
    static const scene_expect_status status[] = { SCENE_EXPECT_PASSED, SCENE_EXPECT_FAILED,
                                                  SCENE_EXPECT_PASSED, SCENE_EXPECT_NOT_REACHED };
    static const double measured[] = { 2, 2, 1, 0 };
    for (int i = 0; i < 4; i++) {
        assert_int_equal(scene_expect_get(s, i).status, status[i]);
        assert_near(scene_expect_get(s, i).measured, measured[i], ROUNDED(1e-5));
    }
    assert_string_equal(scene_expect_get(s, 1).quantity, "stands.error");
    assert_string_equal(scene_expect_get(s, 1).unit, "m");
    assert_near(scene_expect_get(s, 1).time, 1, 1e-9);
    scene_destroy(s);
}

// A caller that does not want expectations looked at pays nothing for them.
static void test_no_expect(void **state)
{
    (void)state;
    const char *text = "scene{ duration = 0.1 }\nbody{ name = 'b', circle{1} }\n"
                       "exact{ 'e', measure = function() score('asked', 1) return 0 end, "
                       "value = function() return 0 end }\n"
                       "expect{ 'form', exact = 'e', tolerance = 1 }\n"
                       "expect{ 'end', test = function() score('asked', 2) return true end }\n";
    for (int without = 0; without < 2; without++) {
        scene *s = NULL;
        scene_error e;
        scene_options options = {
            .path = "t.lua", .text = text, .text_size = strlen(text), .no_expect = without == 1
        };
        assert_int_equal(scene_load(&options, &s, &e), SCENE_OK);
        run(s);
        assert_int_equal(scene_score_count(s), without ? 0 : 1);
        scene_expect_status status = without ? SCENE_EXPECT_PENDING : SCENE_EXPECT_PASSED;
        assert_int_equal(scene_expect_get(s, 0).status, status);
        assert_int_equal(scene_expect_get(s, 1).status, status);
        scene_destroy(s);
    }
}

// What forms say after 1 s, by kind: the place before the angle, the angle before the velocity.
static void test_truth(void **state)
{
    (void)state;
    static const struct {
        const char *form;
        double truth[2];
        bool scaled;
    } rows[] = {
        { "body = 'b', x = function(t) return 2 * t end, angle = function() return 9 end",
          { 2, 0 },
          false },
        { "body = 'b', y = function() return 4 end, vx = function() return 9 end",
          { 0, 4 },
          false },
        { "body = 'b', angle = function() return 3 end, vy = function() return 9 end",
          { 3, 0 },
          false },
        { "body = 'b', vx = function() return 5 end, vy = function() return 6 end, "
          "spin = function() return 9 end",
          { 5, 6 },
          false },
        { "body = 'b', spin = function() return 3 end, scale = 2", { 3, 0 }, true },
        { "measure = function() return 9 end, value = function(t) return 7 * t end",
          { 7, 0 },
          false },
    };
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        char text[512];
        snprintf(text, sizeof text,
                 "scene{ gravity = {0, 0}, dt = 0.25 } body{ name = 'b', circle{1} } exact{ %s }",
                 rows[i].form);
        scene *s = load(text);
        scene_error e;
        double truth[2];
        bool scaled;
        for (int k = 0; k < 4; k++) {
            assert_int_equal(scene_step(s, &e), SCENE_OK);
        }
        assert_int_equal(scene_exact_truth(s, 0, truth, &scaled, &e), SCENE_OK);
        assert_near(truth[0], rows[i].truth[0], 1e-12);
        assert_near(truth[1], rows[i].truth[1], 1e-12);
        assert_int_equal(scaled, rows[i].scaled);
        scene_destroy(s);
    }
}

// What moves a scene instead of its world: here it puts every body 1 m further.
static void move_on(void *context, plumb_world *world, double dt)
{
    plumb_body_span bodies = plumb_world_bodies(world);
    for (int i = 0; i < bodies.dynamic_count; i++) {
        plumb_body body = bodies.body[i];
        plumb_vec2 at = plumb_body_position(world, body);
        assert_int_equal(plumb_body_set_position(world, body, (plumb_vec2){ at.x + 1, at.y }),
                         PLUMB_OK);
    }
    *(double *)context += dt;
}

static void bear(void *context, plumb_joint joint, double force[2], double *torque)
{
    (void)context;
    (void)joint;
    force[0] = 3;
    force[1] = 4;
    *torque = 7;
}

static void test_moved_by_another(void **state)
{
    (void)state;
    double moved = 0;
    static const char text[] =
        "scene{ dt = 0.25 } body{ name = 'b', circle{1} } local j = revolute{ 'b', at = {0, 0} }\n"
        "local x0 = 0\nevery_step(function(t) local x = find('b'):position() x0 = x end)\n"
        "exact{ 'x', body = 'b', x = function(t) return 4 * t end }\n"
        "exact{ 'seen', value = function(t) return 4 * t - 1 end, measure = function() return x0 "
        "end }\n"
        "exact{ 'force', value = function() return 5 + 7 end,\n"
        "       measure = function() return j:reaction() + j:torque() end }";
    scene *s;
    scene_error e;
    scene_options options = { .path = "moved.lua",
                              .text = text,
                              .text_size = sizeof text - 1,
                              .step = move_on,
                              .joint_force = bear,
                              .step_context = &moved };
    assert_int_equal(scene_load(&options, &s, &e), SCENE_OK);
    assert_int_equal(scene_activity(s), SCENE_ACTS);
    for (int k = 0; k < 4; k++) {
        assert_int_equal(scene_step(s, &e), SCENE_OK);
    }
    assert_near(moved, 1, 1e-12);
    for (int i = 0; i < 3; i++) {
        double error;
        assert_int_equal(scene_exact_error(s, i, &error, &e), SCENE_OK);
        assert_near(error, 0, 1e-6);
    }
    scene_destroy(s);
}

static void test_activity(void **state)
{
    (void)state;
    static const struct {
        const char *text;
        unsigned bits;
    } rows[] = {
        { "", 0 },
        { "at(1, function() end)", SCENE_ACTS },
        { "every(1, function() end)", SCENE_ACTS },
        { "split_step(2)", SCENE_ACTS },
        { "on_contact(function() end)", SCENE_LISTENS },
        { "on_hit{ a = 'b', function() end }", SCENE_LISTENS },
        { "edit_contact{ a = 'b', function() end }", SCENE_LISTENS },
        { "field{ body = 'b', function() return 0, 0 end } every_step(function() end)",
          SCENE_FIELDS | SCENE_ACTS },
    };
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        char text[256];
        snprintf(text, sizeof text, "body{ name = 'b', circle{1} } %s", rows[i].text);
        scene *s = load(text);
        assert_int_equal(scene_activity(s), rows[i].bits);
        scene_destroy(s);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_exact),          cmocka_unit_test(test_exact_errors),
        cmocka_unit_test(test_expected_exact), cmocka_unit_test(test_no_expect),
        cmocka_unit_test(test_truth),          cmocka_unit_test(test_moved_by_another),
        cmocka_unit_test(test_activity),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
