// test_api_wrap.c - what worlds that wrap around refuse, and with what words; nothing changes then.
#include "plumb/plumb.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>
#include <cmocka.h>

#define R(x) ((plumb_real)(x))

static void keep_line(void *context, plumb_log_level level, const char *message)
{
    (void)level;
    strncpy(context, message, 511);
}

static void periods_out_of_range(void **state)
{
    (void)state;
    const struct {
        plumb_real x, y;
        plumb_result code;
        const char *message;
    } table[] = {
        { -1, 0, PLUMB_E_RANGE, "plumb_world_create: wrap_x is -1; it must be 0, or 0.1 to 2e+09" },
        { R(0.0625), 0, PLUMB_E_RANGE,
          "plumb_world_create: wrap_x is 0.0625; it must be 0, or 0.1 to 2e+09" },
        { 20, R(4e9), PLUMB_E_RANGE,
          "plumb_world_create: wrap_y is 4e+09; it must be 0, or 0.1 to 2e+09" },
        { R(NAN), 0, PLUMB_E_NOT_FINITE, "plumb_world_create: wrap_x is nan; it must be finite" },
        { 0, R(INFINITY), PLUMB_E_NOT_FINITE,
          "plumb_world_create: wrap_y is inf; it must be finite" },
    };
    for (size_t i = 0; i < sizeof table / sizeof table[0]; ++i) {
        char line[512] = "";
        plumb_world *w;
        plumb_world_desc desc = {
            .wrap_x = table[i].x, .wrap_y = table[i].y, .log = keep_line, .hook_context = line
        };
        assert_int_equal(plumb_world_create(&desc, &w), table[i].code);
        assert_null(w);
        assert_string_equal(line, table[i].message);
    }
}

static plumb_world *open_world(void)
{
    plumb_world *w;
    assert_int_equal(plumb_world_create(&(plumb_world_desc){ .wrap_x = 16, .wrap_y = 8 }, &w),
                     PLUMB_OK);
    return w;
}

static void shapes_too_large(void **state)
{
    (void)state;
    plumb_world *w = open_world();
    const plumb_vec2 line[2] = { { -2, 0 }, { 2, 0 } };
    const plumb_vec2 around[7] = { { -8, 0 }, { -5, 0 }, { -2, 1 }, { 1, 0 },
                                   { 4, 0 },  { 7, 0 },  { 11, 0 } };
    plumb_body body = plumb_body_create(w, &(plumb_body_desc){ .type = PLUMB_STATIC });
    plumb_body ball = plumb_body_create(w, &(plumb_body_desc){ 0 });
    plumb_shape small =
        plumb_shape_create(w, ball, &(plumb_shape_desc){ .kind = PLUMB_CIRCLE, .radius = 1 });
    const plumb_shape_desc refused[] = {
        { .kind = PLUMB_CIRCLE, .radius = 2 },
        { .kind = PLUMB_BOX, .half = { 2, R(0.5) } },
        { .kind = PLUMB_SEGMENT, .points = line, .count = 2 },
    };
    for (size_t i = 0; i < sizeof refused / sizeof refused[0]; ++i) {
        assert_true(plumb_is_null(plumb_shape_create(w, body, &refused[i])));
        assert_int_equal(plumb_world_error(w).code, PLUMB_E_RANGE);
        assert_non_null(
            strstr(plumb_world_error(w).message,
                   "m across; in a world that wraps every 8 m each convex piece must be "
                   "below 4"));
        assert_int_equal(plumb_shape_set_geometry(w, small, &refused[i]), PLUMB_E_RANGE);
    }
    assert_string_equal(plumb_world_error(w).function, "plumb_shape_set_geometry");
    assert_int_equal(plumb_world_stats(w).shape_count, 1);
    // A chain all around is made of short pieces; one that is too long is enough.
    assert_false(plumb_is_null(plumb_shape_create(
        w, body, &(plumb_shape_desc){ .kind = PLUMB_CHAIN, .points = around, .count = 6 })));
    assert_true(plumb_is_null(plumb_shape_create(
        w, body, &(plumb_shape_desc){ .kind = PLUMB_CHAIN, .points = around, .count = 7 })));
    assert_int_equal(plumb_world_stats(w).shape_count, 2);
    plumb_world_destroy(w);
}

static void queries_too_long(void **state)
{
    (void)state;
    plumb_world *w = open_world();
    plumb_ray_hit hit;
    const plumb_vec2 zero = { 0, 0 };
    assert_false(plumb_world_ray(w, zero, plumb_v2(129, 0), NULL, &hit));
    assert_string_equal(
        plumb_world_error(w).message,
        "plumb_world_ray: the ray is 129 m along x; in a world that wraps every 16 m it "
        "must be at most 128");
    assert_int_equal(plumb_world_ray_all(w, zero, plumb_v2(0, -65), NULL, &hit, 1), -1);
    assert_string_equal(
        plumb_world_error(w).message,
        "plumb_world_ray_all: the ray is 65 m along y; in a world that wraps every 8 m it "
        "must be at most 64");
    const plumb_ray rays[2] = { { zero, { 1, 0 } }, { zero, { -200, 0 } } };
    plumb_ray_hit hits[2];
    assert_int_equal(plumb_world_ray_batch(w, rays, 2, NULL, hits), -1);
    assert_string_equal(
        plumb_world_error(w).message,
        "plumb_world_ray_batch: rays[1] is 200 m along x; in a world that wraps every 16 "
        "m it must be at most 128");
    plumb_convex box;
    plumb_convex_box(plumb_v2(1, 1), zero, 0, 0, &box);
    plumb_cast cast = { .convex = &box,
                        .transform = { zero, { 1, 0 } },
                        .translation = { 127, 0 } };
    plumb_cast_hit met;
    assert_false(plumb_world_cast(w, &cast, NULL, &met));
    assert_string_equal(
        plumb_world_error(w).message,
        "plumb_world_cast: translation with the shape is 129 m along x; in a world that wraps "
        "every 16 m it must be at most 128");
    assert_int_equal(plumb_world_cast_batch(w, &cast, 1, NULL, &met), -1);
    assert_string_equal(
        plumb_world_error(w).message,
        "plumb_world_cast_batch: casts[0].translation with the shape is 129 m along x; in a "
        "world that wraps every 16 m it must be at most 128");
    plumb_convex wide;
    plumb_convex_box(plumb_v2(65, 1), zero, 0, 0, &wide);
    plumb_shape shape;
    assert_int_equal(plumb_world_overlap_convex(w, &wide, cast.transform, NULL, &shape, 1), -1);
    assert_string_equal(
        plumb_world_error(w).message,
        "plumb_world_overlap_convex: the shape is 130 m along x; in a world that wraps "
        "every 16 m it must be at most 128");
    assert_int_equal(plumb_world_explode(w, &(plumb_explosion_desc){ .radius = 33, .impulse = 1 }),
                     PLUMB_E_RANGE);
    assert_string_equal(
        plumb_world_error(w).message,
        "plumb_world_explode: the blast is 66 m along y; in a world that wraps every 8 m "
        "it must be at most 64");
    plumb_world_destroy(w);
}

static void no_world_no_period(void **state)
{
    (void)state;
    plumb_vec2 p = plumb_world_wrapped(NULL, plumb_v2(100, -7));
    assert_true(p.x == 100 && p.y == -7);
    p = plumb_world_way(NULL, plumb_v2(1, 2), plumb_v2(-3, 5));
    assert_true(p.x == -4 && p.y == 3);
    plumb_world *w;
    assert_int_equal(plumb_world_create(NULL, &w), PLUMB_OK);
    assert_true(plumb_world_settings(w).wrap_x == 0 && plumb_world_settings(w).wrap_y == 0);
    assert_true(plumb_world_wrapped(w, plumb_v2(R(1e8), 0)).x == R(1e8));
    assert_true(plumb_world_way(w, plumb_v2(1, 2), plumb_v2(R(1e8), 5)).y == 3);
    plumb_world_destroy(w);
}

static bool edges_scheduled(plumb_world *w)
{
    plumb_pass_info rows[128];
    int count = plumb_world_schedule(w, rows, 128);
    for (int i = 0; i < count; ++i) {
        if (strcmp(rows[i].name, "edges") == 0) {
            assert_string_equal(rows[i].reason, rows[i].scheduled ? "the world wraps around"
                                                                  : "the world does not wrap");
            return rows[i].scheduled;
        }
    }
    fail();
    return false;
}

static void explained_by_the_schedule(void **state)
{
    (void)state;
    plumb_world *w = open_world(), *plain;
    assert_int_equal(plumb_world_create(NULL, &plain), PLUMB_OK);
    plumb_world_step(w, R(0.01));
    plumb_world_step(plain, R(0.01));
    assert_true(edges_scheduled(w));
    assert_false(edges_scheduled(plain));
    plumb_world_destroy(w);
    plumb_world_destroy(plain);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(periods_out_of_range),      cmocka_unit_test(shapes_too_large),
        cmocka_unit_test(queries_too_long),          cmocka_unit_test(no_world_no_period),
        cmocka_unit_test(explained_by_the_schedule),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
