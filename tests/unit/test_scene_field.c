// test_scene_field.c - field{}: accelerations of scripts within the substep, of second order whatever they depend on.
#define _POSIX_C_SOURCE 200809L // open_memstream
#include "scene_fixture.h"

// Runs the scene with so many substeps; the largest error of its only form, which its only line holds.
static double error_of(const char *text, const char *set)
{
    scene *s = load_as("test.lua", text, strlen(text), set);
    run(s);
    double measured = scene_expect_get(s, 0).measured;
    scene_destroy(s);
    return measured;
}

// Against closed forms; half a substep must leave a quarter of the error. In float rounding is below that.
static void test_second_order(void **state)
{
    (void)state;
    static const struct {
        const char *what, *text;
        double most; ///< with 4 substeps
    } rows[] = {
        { "an orbit returns",
          "scene{ gravity = {0, 0}, dt = 1/60, duration = 6.3, sleep = false }\n"
          "body{ name = 'moon', circle{0.05}, at = {1.5, 0}, velocity = {0, math.sqrt(1/3)} }\n"
          "field{ body = 'moon', function(x, y) local r = math.sqrt(x*x + y*y)\n"
          "    return -x / (r*r*r), -y / (r*r*r) end }\n"
          "exact{ 'e', measure = function() local m = find('moon') local x, y = m:position()\n"
          "    return m:speed()*m:speed() / 2 - 1 / math.sqrt(x*x + y*y) end,\n"
          "    value = function() return -0.5 end }\n",
          2e-5 },
        { "a charge drifts across crossed fields",
          "scene{ gravity = {0, 0}, dt = 1/60, duration = 2, sleep = false }\n"
          "body{ name = 'ion', circle{0.05}, at = {0, 0} }\n"
          "field{ body = 'i*', function(x, y, vx, vy) return 12 * vy, 6 - 12 * vx end }\n"
          "exact{ 'e', body = 'ion', x = function(t) return 0.5 * t - math.sin(12 * t) / 24 end,\n"
          "    y = function(t) return (1 - math.cos(12 * t)) / 24 end }\n",
          4e-4 },
        { "a needle swings, and time matters",
          "scene{ gravity = {0, 0}, dt = 1/60, duration = 2, sleep = false }\n"
          "body{ name = 'needle', box{1, 0.1}, angle = 1 }\n"
          "field{ body = 'needle', function(x, y, vx, vy, t, body, angle, spin)\n"
          "    return 6 * t, nil, -100 * angle end }\n"
          "exact{ 'e', body = 'needle', angle = function(t) return math.cos(10 * t) end }\n",
          2.6e-3 },
    };
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        char text[1200];
        snprintf(text, sizeof text, "%sexpect{ 'holds', exact = 'e', tolerance = %g }\n",
                 rows[i].text, rows[i].most);
        double coarse = error_of(text, "substeps=4"), fine = error_of(text, "substeps=8");
        printf("%s: %.3g, %.3g\n", rows[i].what, coarse, fine);
        assert_true(coarse < rows[i].most);
        assert_true(fine < coarse * 0.3 || fine < ROUNDED(1e-5));
    }
}

static void test_who_is_meant(void **state)
{
    (void)state;
    scene *s =
        load("scene{ gravity = {0, 0}, duration = 1 }\n"
             "body{ name = 'a1', circle{0.1} }\nbody{ name = 'a2', circle{0.1}, at = {5, 0} }\n"
             "body{ name = 'b', circle{0.1}, at = {0, 5} }\n"
             "field{ body = 'a*', function(x, y, vx, vy, t, body)\n"
             "    return body:name() == 'a1' and 2 or 4 end }\n"
             "field{ body = 'a2', function() return 0, 6 end }\n"
             "expect{ 'first', body = 'a1', position = {1, 0}, tolerance = 1e-4 }\n"
             "expect{ 'second', body = 'a2', position = {7, 3}, tolerance = 1e-4 }\n"
             "expect{ 'none', body = 'b', position = {0, 5}, tolerance = 0 }\n");
    run(s);
    assert_int_equal(scene_expect_failures(s), 0);
    scene_destroy(s);
}

// What goes wrong within the step is told when it is over, and the scene stays failed.
static void test_errors(void **state)
{
    (void)state;
    static const char *const rows[][2] = {
        { "return 'left'", "test.lua:2:1: the function of field{} must return finite numbers ax, "
                           "ay [m/s^2] and perhaps aw [rad/s^2], not a string" },
        { "return 0, 1/0", "test.lua:2:1: the function of field{} must return finite numbers ax, "
                           "ay [m/s^2] and perhaps aw [rad/s^2], not a number" },
        { "error('no')", "test.lua:2:1: no" },
        { "body{ circle{1} }", NULL },
    };
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        char text[400];
        snprintf(text, sizeof text,
                 "body{ name = 'a', circle{1} }\nfield{ body = 'a', function() %s end }",
                 rows[i][0]);
        scene *s = load(text);
        scene_error e = { 0 }, again = { 0 };
        assert_int_not_equal(scene_step(s, &e), SCENE_OK);
        if (rows[i][1] != NULL) {
            assert_string_equal(e.text, rows[i][1]);
        }
        assert_int_equal(scene_step(s, &again), e.code);
        scene_destroy(s);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_second_order),
        cmocka_unit_test(test_who_is_meant),
        cmocka_unit_test(test_errors),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
