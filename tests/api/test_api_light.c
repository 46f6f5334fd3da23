// test_api_light.c - rays of light as a user has them: refused calls, defaults, what is written and what is cut, filters, sensors, one-way
// shapes, lines, worlds that wrap, starts in and at shapes, no memory, no trace of them in a world.
#include "harness/heap.h"
#include "world_fixture.h"

#include <stdlib.h>

#define MOST 256

static plumb_light_segment path[MOST];
static plumb_light_sum sum;

static plumb_world *make_world(void)
{
    plumb_world *w;
    assert_int_equal(plumb_world_create(&(plumb_world_desc){ .zero_gravity = true }, &w), PLUMB_OK);
    return w;
}

static plumb_material optical(plumb_world *w, double index, double reflectance)
{
    return plumb_material_create(
        w, &(plumb_material_desc){ .refractive_index = R(index), .reflectance = R(reflectance) });
}

static plumb_shape box_at(plumb_world *w, double x, double y, plumb_material m)
{
    const plumb_body b = plumb_body_create(
        w, &(plumb_body_desc){ .type = PLUMB_STATIC, .position = { R(x), R(y) } });
    return plumb_shape_create(
        w, b, &(plumb_shape_desc){ .kind = PLUMB_BOX, .half = { 1, 1 }, .material = m });
}

static const plumb_light_desc level = { .direction = { 1, 0 } };

static int shine(plumb_world *w, plumb_light_desc d, const plumb_query_filter *filter)
{
    const int count = plumb_world_light(w, &d, filter, path, MOST, &sum);
    assert_true(count > 0);
    assert_near(sum.absorbed + sum.left + sum.cut, sum.sent, 1e-14 * sum.sent);
    return count;
}

//---- calls ---------------------------------------------------------------------------------------

static void assert_refused(plumb_world *w, const plumb_light_desc *d, plumb_result code,
                           const char *field)
{
    memset(path, 0x5a, sizeof path);
    assert_int_equal(plumb_world_light(w, d, NULL, path, MOST, &sum), -1);
    assert_int_equal(plumb_world_error(w).code, code);
    if (strstr(plumb_world_error(w).message, field) == NULL) {
        fail_msg("%s: %s", field, plumb_world_error(w).message);
    }
    assert_int_equal(*(unsigned char *)path, 0x5a);
}

static void bad_rays_are_refused(void **state)
{
    (void)state;
    plumb_world *w = make_world();
    const plumb_real nan = R(NAN), inf = R(INFINITY);
    const struct {
        plumb_light_desc d;
        plumb_result code;
        const char *field;
    } rows[] = {
        { { .direction = { 0, 0 } }, PLUMB_E_RANGE, "direction" },
        { { .direction = { nan, 0 } }, PLUMB_E_NOT_FINITE, "direction" },
        { { .direction = { 0, inf } }, PLUMB_E_NOT_FINITE, "direction" },
        { { .from = { nan, 0 }, .direction = { 1, 0 } }, PLUMB_E_NOT_FINITE, "from" },
        { { .from = { 0, R(2e12) }, .direction = { 1, 0 } }, PLUMB_E_RANGE, "from" },
        { { .direction = { 1, 0 }, .length = -1 }, PLUMB_E_RANGE, "length" },
        { { .direction = { 1, 0 }, .length = nan }, PLUMB_E_NOT_FINITE, "length" },
        { { .direction = { 1, 0 }, .length = R(2e12) }, PLUMB_E_RANGE, "length" },
        { { .direction = { 1, 0 }, .power = -1 }, PLUMB_E_RANGE, "power" },
        { { .direction = { 1, 0 }, .power = inf }, PLUMB_E_NOT_FINITE, "power" },
        { { .direction = { 1, 0 }, .polarization = R(1.1) }, PLUMB_E_RANGE, "polarization" },
        { { .direction = { 1, 0 }, .polarization = nan }, PLUMB_E_NOT_FINITE, "polarization" },
        { { .direction = { 1, 0 }, .min_power = -1 }, PLUMB_E_RANGE, "min_power" },
        { { .direction = { 1, 0 }, .min_power = nan }, PLUMB_E_NOT_FINITE, "min_power" },
        { { .direction = { 1, 0 }, .index = 11 }, PLUMB_E_RANGE, "index" },
        { { .direction = { 1, 0 }, .index = nan }, PLUMB_E_NOT_FINITE, "index" },
        { { .direction = { 1, 0 }, .max_bounces = -1 }, PLUMB_E_RANGE, "max_bounces" },
        { { .direction = { 1, 0 }, .max_bounces = PLUMB_LIGHT_MAX_BOUNCES + 1 },
          PLUMB_E_RANGE,
          "max_bounces" },
    };
    for (size_t i = 0; i < sizeof rows / sizeof *rows; ++i) {
        assert_refused(w, &rows[i].d, rows[i].code, rows[i].field);
    }
    assert_refused(w, NULL, PLUMB_E_NULL, "desc");
    assert_int_equal(plumb_world_light(NULL, &level, NULL, path, MOST, &sum), -1);
    assert_int_equal(plumb_world_light(w, &level, NULL, NULL, 1, &sum), -1);
    assert_int_equal(plumb_world_error(w).code, PLUMB_E_NULL);
    assert_int_equal(plumb_world_light(w, &level, NULL, path, -1, &sum), -1);
    assert_int_equal(plumb_world_error(w).code, PLUMB_E_RANGE);
    const plumb_body gone = plumb_body_create(w, &(plumb_body_desc){ 0 });
    plumb_body_destroy(w, gone);
    const plumb_query_filter filter = { .ignore_body = gone };
    assert_int_equal(plumb_world_light(w, &level, &filter, path, MOST, &sum), -1);
    assert_int_equal(plumb_world_error(w).code, PLUMB_E_HANDLE);
    plumb_world_destroy(w);
    // Of a world that wraps, a way of 8 periods at most.
    assert_int_equal(plumb_world_create(&(plumb_world_desc){ .wrap_x = 10 }, &w), PLUMB_OK);
    assert_refused(w, &(plumb_light_desc){ .direction = { 0, 1 }, .length = 81 }, PLUMB_E_RANGE,
                   "ray");
    plumb_world_destroy(w);
}

static void materials_have_their_ranges(void **state)
{
    (void)state;
    plumb_world *w = make_world();
    const plumb_material_desc bad[] = {
        { .refractive_index = -1 }, { .refractive_index = R(10.1) }, { .refractive_index = R(NAN) },
        { .reflectance = R(-0.1) }, { .reflectance = R(1.1) },       { .reflectance = R(NAN) },
        { .absorption = -1 },       { .absorption = R(2e9) },        { .absorption = R(INFINITY) },
    };
    for (size_t i = 0; i < sizeof bad / sizeof *bad; ++i) {
        assert_true(plumb_is_null(plumb_material_create(w, &bad[i])));
        const plumb_result code = plumb_world_error(w).code;
        assert_true(code == PLUMB_E_RANGE || code == PLUMB_E_NOT_FINITE);
    }
    const plumb_material_desc good = { .refractive_index = R(1.5),
                                       .reflectance = R(0.1),
                                       .absorption = 2 };
    plumb_material_desc got;
    const plumb_material m = plumb_material_create(w, &good);
    assert_int_equal(plumb_material_settings(w, m, &got), PLUMB_OK);
    assert_true(got.refractive_index == good.refractive_index &&
                got.reflectance == good.reflectance && got.absorption == 2);
    assert_int_equal(plumb_material_settings(w, NO_MATERIAL, &got), PLUMB_OK);
    assert_true(got.refractive_index == 0 && got.reflectance == 0 && got.absorption == 0);
    plumb_world_destroy(w);
}

// Nothing is met; all defaults.
static void an_empty_world_is_dark(void **state)
{
    (void)state;
    plumb_world *w = make_world();
    assert_int_equal(shine(w, level, NULL), 1);
    assert_near(path[0].to.x, 1000, 0);
    assert_near(path[0].power, 1, 0);
    assert_near(path[0].polarization, 0, 0);
    assert_near(path[0].index, 1, 0);
    assert_int_equal(path[0].parent, -1);
    assert_int_equal(path[0].how, PLUMB_LIGHT_SENT);
    assert_true(plumb_is_null(path[0].shape) && plumb_is_null(path[0].body));
    assert_near(sum.left, 1, 0);
    // Extremes stay numbers.
    const plumb_light_desc far = { .from = { R(1e12), 0 },
                                   .direction = { R(1e-30), R(1e30) },
                                   .length = R(1e12),
                                   .power = R(1e12),
                                   .min_power = R(1e12),
                                   .index = 10 };
    shine(w, far, NULL);
    assert_true(plumb_vec2_is_finite(path[0].to));
    plumb_world_destroy(w);
}

// What is beyond the capacity, below the least power, behind the last bounce is cut, and told.
static void what_is_not_followed_is_told(void **state)
{
    (void)state;
    plumb_world *w = make_world();
    box_at(w, 3, 0, optical(w, 1.5, 0));
    plumb_light_desc d = { .direction = { R(0.9), R(0.1) }, .min_power = R(1e-9) };
    const int all = shine(w, d, NULL);
    static plumb_light_segment whole[MOST];
    memcpy(whole, path, sizeof path);
    assert_true(all > 6);
    for (int capacity = 0; capacity <= all; ++capacity) {
        memset(path, 0, sizeof path);
        assert_int_equal(plumb_world_light(w, &d, NULL, path, capacity, &sum), capacity);
        assert_memory_equal(path, whole, (size_t)capacity * sizeof *path);
        assert_near(sum.cut + sum.left + sum.absorbed, 1, 1e-14);
        assert_true(capacity == all || sum.cut > 1e-9);
    }
    assert_int_equal(plumb_world_light(w, &d, NULL, NULL, 0, NULL), 0);
    d.max_bounces = 1;
    assert_int_equal(shine(w, d, NULL), 3);
    assert_true(path[1].depth == 1 && path[1].power > path[2].power); // the stronger first
    d.max_bounces = 0;
    d.min_power = R(0.5);
    const int strong = shine(w, d, NULL);
    assert_true(strong < all && sum.cut > 0.05);
    for (int i = 0; i < strong; ++i) {
        assert_true((double)path[i].power >= 0.5);
    }
    plumb_world_destroy(w);
}

static void filters_sensors_and_one_way(void **state)
{
    (void)state;
    plumb_world *w = make_world();
    const plumb_shape first = box_at(w, 3, 0, NO_MATERIAL), second = box_at(w, 6, 0, NO_MATERIAL);
    shine(w, level, NULL);
    assert_true(plumb_same(path[0].shape, first));
    assert_near(path[0].absorbed, 1, 0);
    assert_vec_near(path[0].normal, -1, 0, 0);
    plumb_query_filter filter = { .ignore_body = plumb_shape_body(w, first) };
    shine(w, level, &filter);
    assert_true(plumb_same(path[0].shape, second) &&
                plumb_same(path[0].body, plumb_shape_body(w, second)));
    filter = (plumb_query_filter){ .mask = 2 };
    shine(w, level, &filter);
    assert_true(plumb_is_null(path[0].shape));
    filter = (plumb_query_filter){ .ignore_static = true };
    shine(w, level, &filter);
    assert_true(plumb_is_null(path[0].shape));
    // A sensor is none to light, unless it is of something that light goes through and the filter sees it.
    assert_int_equal(plumb_shape_set_sensor(w, first, true), PLUMB_OK);
    filter = (plumb_query_filter){ .sensors = true };
    shine(w, level, &filter);
    assert_true(plumb_same(path[0].shape, second));
    assert_int_equal(plumb_shape_set_material(w, first, optical(w, 1.33, 0)), PLUMB_OK);
    shine(w, level, NULL);
    assert_true(plumb_same(path[0].shape, second));
    shine(w, level, &filter);
    assert_true(plumb_same(path[0].shape, first));
    // One-way shapes are met from all sides, or as the filter says.
    assert_int_equal(plumb_shape_set_one_way(w, second, (plumb_one_way){ .direction = { 1, 0 } }),
                     PLUMB_OK);
    shine(w, level, NULL);
    assert_true(plumb_same(path[0].shape, second));
    filter = (plumb_query_filter){ .one_way = true };
    shine(w, level, &filter);
    assert_true(plumb_is_null(path[0].shape));
    shine(w, (plumb_light_desc){ .from = { 12, 0 }, .direction = { -1, 0 } }, &filter);
    assert_true(plumb_same(path[0].shape, second));
    plumb_world_destroy(w);
}

static bool only_second(void *context, plumb_shape shape)
{
    return plumb_same(shape, *(plumb_shape *)context);
}

static void filters_may_accept(void **state)
{
    (void)state;
    plumb_world *w = make_world();
    box_at(w, 3, 0, optical(w, 1.5, 0));
    plumb_shape second = box_at(w, 6, 0, NO_MATERIAL);
    const plumb_query_filter filter = { .accept = only_second, .context = &second };
    assert_int_equal(shine(w, level, &filter), 1);
    assert_true(plumb_same(path[0].shape, second));
    plumb_world_destroy(w);
}

// In glass, at its surface in either direction, in what is opaque, on a line.
static void starts_in_and_at_shapes(void **state)
{
    (void)state;
    plumb_world *w = make_world();
    const plumb_shape glass = box_at(w, 3, 0, optical(w, 1.5, 0));
    shine(w, (plumb_light_desc){ .from = { 3, 0 }, .direction = { 1, 0 } }, NULL);
    assert_near(path[0].index, 1.5, 1e-7);
    assert_near(path[0].to.x, 4, 0);
    assert_near(path[1].power, 0.96, 1e-6);
    shine(w, (plumb_light_desc){ .from = { 2, 0 }, .direction = { -1, 0 } }, NULL); // away from it
    assert_true(path[0].index == 1 && plumb_is_null(path[0].shape));
    shine(w, (plumb_light_desc){ .from = { 2, 0 }, .direction = { 1, 0 } }, NULL); // into it
    assert_near(path[0].index, 1.5, 1e-7);
    assert_near(path[0].to.x, 4, 0);
    shine(w, (plumb_light_desc){ .from = { 4, 0 }, .direction = { 1, 0 } }, NULL); // out of it
    assert_true(path[0].index == 1 && plumb_is_null(path[0].shape));
    shine(w, (plumb_light_desc){ .from = { R(2.5), 1 }, .direction = { 1, 0 } }, NULL); // along it
    assert_true(plumb_is_null(path[0].shape) || plumb_same(path[0].shape, glass));
    plumb_shape_set_material(w, glass, optical(w, 0, 1));
    assert_int_equal(shine(w, (plumb_light_desc){ .from = { 3, 0 }, .direction = { 1, 0 } }, NULL),
                     1);
    assert_vec_near(path[0].to, 3, 0, 0);
    assert_vec_near(path[0].normal, 0, 0, 0);
    assert_near(path[0].absorbed, 1, 0);
    shine(w, (plumb_light_desc){ .from = { 2, 0 }, .direction = { -1, 0 } }, NULL);
    assert_true(plumb_is_null(path[0].shape));
    shine(w, (plumb_light_desc){ .from = { 2, 0 }, .direction = { 1, 0 } }, NULL);
    assert_true(plumb_same(path[0].shape, glass) && path[1].to.x < -900);
    plumb_world_destroy(w);
}

// Over the edge of a world that wraps around.
static void wrapped_worlds(void **state)
{
    (void)state;
    plumb_world *w;
    assert_int_equal(plumb_world_create(&(plumb_world_desc){ .wrap_x = 20 }, &w), PLUMB_OK);
    const plumb_shape mirror = box_at(w, -8, 0, optical(w, 0, 1));
    assert_int_equal(shine(w, (plumb_light_desc){ .from = { 5, 0 }, .direction = { 1, 0 } }, NULL),
                     10);
    assert_true(plumb_same(path[0].shape, mirror));
    assert_near(path[0].to.x, 11, 1e-6);
    assert_near(path[1].to.x, -7, 1e-6); // its image on the other side
    assert_near(path[2].to.x, 11, 1e-6);
    plumb_world_destroy(w);
}

//---- the world is not touched --------------------------------------------------------------------

static void add_many(plumb_world *w)
{
    for (int i = 0; i < 60; ++i) {
        const plumb_body b =
            plumb_body_create(w, &(plumb_body_desc){ .position = { R(i % 8 * 1.5 - 5), R(i / 8.0) },
                                                     .angle = R(0.1 * i),
                                                     .velocity = { R(0.1 * i - 2), 0 } });
        plumb_shape_create(
            w, b,
            &(plumb_shape_desc){ .kind = PLUMB_BOX,
                                 .half = { R(0.4), R(0.3) },
                                 .material = optical(w, i % 3 ? 1 + 0.02 * i : 0, 0.5) });
    }
}

static int shine_about(plumb_world *w, int from)
{
    int count = 0;
    for (int i = 0; i < 20; ++i) {
        const plumb_light_desc d = { .from = { -8, R(0.3 * i) },
                                     .direction = { 1, R(0.01 * (i + from)) } };
        count += shine(w, d, NULL);
    }
    return count;
}

static void rays_leave_no_trace_and_take_no_memory(void **state)
{
    (void)state;
    static heap h;
    h = (heap){ .fail_at = -1 };
    plumb_world *worlds[2];
    for (int k = 0; k < 2; ++k) {
        const plumb_world_desc desc = { .allocator = heap_allocator(&h) };
        assert_int_equal(plumb_world_create(k == 0 ? &desc : NULL, &worlds[k]), PLUMB_OK);
        add_many(worlds[k]);
    }
    shine_about(worlds[0], 0); // files the grids
    int pieces = 0;
    for (int i = 0; i < 60; ++i) {
        plumb_world_step(worlds[0], R(1.0 / 60));
        plumb_world_step(worlds[1], R(1.0 / 60));
        plumb_world_ray_any(worlds[0], (plumb_vec2){ 0, 0 }, (plumb_vec2){ 1, 0 }, NULL);
        const uint64_t hash = plumb_world_hash(worlds[0]);
        const long calls = h.calls;
        pieces += shine_about(worlds[0], i);
        assert_int_equal(h.calls, calls);
        assert_true(plumb_world_hash(worlds[0]) == hash && plumb_world_hash(worlds[1]) == hash);
    }
    print_message("%d pieces of light in a world that moves\n", pieces);
    plumb_world_destroy(worlds[0]);
    plumb_world_destroy(worlds[1]);
}

// What a material is to light is part of images, and of no hash where nobody said it.
static void images_keep_materials(void **state)
{
    (void)state;
    static unsigned char image[1 << 20];
    plumb_world *w = make_world(), *other = make_world();
    add_many(w);
    const size_t size = plumb_world_snapshot_size(w);
    assert_true(size > 0 && size <= sizeof image);
    assert_int_equal(plumb_world_save(w, image, sizeof image), PLUMB_OK);
    assert_int_equal(plumb_world_restore(other, image, size), PLUMB_OK);
    assert_true(plumb_world_hash(w) == plumb_world_hash(other));
    static plumb_light_segment first[MOST];
    for (int i = 0; i < 20; ++i) {
        const plumb_light_desc d = { .from = { -8, R(0.3 * i) }, .direction = { 1, R(0.02 * i) } };
        const int count = shine(w, d, NULL);
        memcpy(first, path, sizeof path);
        assert_int_equal(shine(other, d, NULL), count);
        assert_memory_equal(first, path, (size_t)count * sizeof *path);
    }
    plumb_world_destroy(w);
    plumb_world_destroy(other);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(bad_rays_are_refused),
        cmocka_unit_test(materials_have_their_ranges),
        cmocka_unit_test(an_empty_world_is_dark),
        cmocka_unit_test(what_is_not_followed_is_told),
        cmocka_unit_test(filters_sensors_and_one_way),
        cmocka_unit_test(filters_may_accept),
        cmocka_unit_test(starts_in_and_at_shapes),
        cmocka_unit_test(wrapped_worlds),
        cmocka_unit_test(rays_leave_no_trace_and_take_no_memory),
        cmocka_unit_test(images_keep_materials),
    };
    return cmocka_run_group_tests_name("light", tests, NULL, NULL);
}
