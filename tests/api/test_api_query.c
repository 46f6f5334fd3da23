// test_api_query.c - every wrong call of the queries: what it returns, its code, its exact message;
// and that it leaves outputs and world as they were.

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "harness/heap.h"
#include "plumb/plumb.h"

#define R(x)    ((plumb_real)(x))
#define V(x, y) plumb_v2(R(x), R(y))
#define ROOM    200

static const plumb_transform here = { { 0, 0 }, { 1, 0 } };

typedef struct fixture {
    plumb_world *world;
    plumb_body ball, stale;
    plumb_shape shape;
    heap heap;
    char log[512]; // last message
} fixture;

static void keep_message(void *context, plumb_log_level level, const char *message)
{
    fixture *f = context;
    assert_int_equal(level, PLUMB_LOG_ERROR);
    snprintf(f->log, sizeof f->log, "%s", message);
}

static void setup(fixture *f)
{
    memset(f, 0, sizeof *f);
    f->heap = (heap)HEAP_INIT;
    plumb_world_desc desc = { .allocator = heap_allocator(&f->heap),
                              .log = keep_message,
                              .hook_context = f };
    assert_int_equal(plumb_world_create(&desc, &f->world), PLUMB_OK);
    f->stale = plumb_body_create(f->world, &(plumb_body_desc){ 0 });
    f->ball = plumb_body_create(f->world, &(plumb_body_desc){ 0 });
    plumb_shape_desc circle = { .kind = PLUMB_CIRCLE, .radius = 1 };
    f->shape = plumb_shape_create(f->world, f->ball, &circle);
    assert_int_equal(plumb_body_destroy(f->world, f->stale), PLUMB_OK);
    assert_false(plumb_is_null(f->shape));
}

static void teardown(fixture *f)
{
    plumb_world_destroy(f->world);
    assert_int_equal(f->heap.bytes, 0);
}

static void refused(fixture *f, plumb_result code, const char *function, const char *rest)
{
    char message[300];
    snprintf(message, sizeof message, "%s: %s", function, rest);
    plumb_error error = plumb_world_error(f->world);
    assert_string_equal(error.message, message);
    assert_string_equal(error.function, function);
    assert_int_equal(error.code, code);
    assert_string_equal(f->log, message);
    f->log[0] = '\0';
}

//---- all of them, called with the same wrong thing ------------------------------------------------

static plumb_ray_hit ray_hits[ROOM];
static plumb_shape shapes[ROOM];
static plumb_nearest_hit near_hit, near_hits[ROOM];
static plumb_cast_hit cast_hits[ROOM];

typedef struct args {
    plumb_vec2 at; // from, point, transform.p, box.min
    const plumb_query_filter *filter;
    bool no_output;
    int capacity;
} args;

static int ray(plumb_world *w, const args *a)
{
    return plumb_world_ray(w, a->at, V(9, 9), a->filter, a->no_output ? NULL : ray_hits);
}

static int ray_all(plumb_world *w, const args *a)
{
    return plumb_world_ray_all(w, a->at, V(9, 9), a->filter, a->no_output ? NULL : ray_hits,
                               a->capacity);
}

static int overlap_aabb(plumb_world *w, const args *a)
{
    plumb_aabb box = { a->at, { 9, 9 } };
    return plumb_world_overlap_aabb(w, box, a->filter, a->no_output ? NULL : shapes, a->capacity);
}

static int overlap_convex(plumb_world *w, const args *a)
{
    plumb_convex circle;
    assert_int_equal(plumb_convex_circle(V(0, 0), 1, &circle), PLUMB_OK);
    plumb_transform t = { a->at, { 1, 0 } };
    return plumb_world_overlap_convex(w, &circle, t, a->filter, a->no_output ? NULL : shapes,
                                      a->capacity);
}

static int overlap_point(plumb_world *w, const args *a)
{
    return plumb_world_overlap_point(w, a->at, a->filter, a->no_output ? NULL : shapes,
                                     a->capacity);
}

static int nearest(plumb_world *w, const args *a)
{
    return plumb_world_nearest(w, a->at, 9, a->filter, a->no_output ? NULL : &near_hit);
}

static int ray_any(plumb_world *w, const args *a)
{
    return plumb_world_ray_any(w, a->at, V(9, 9), a->filter);
}

static int ray_batch(plumb_world *w, const args *a)
{
    plumb_ray r = { a->at, { 9, 9 } };
    return plumb_world_ray_batch(w, &r, 1, a->filter, a->no_output ? NULL : ray_hits);
}

static plumb_convex unit_circle;

static plumb_cast cast_from(const args *a)
{
    assert_int_equal(plumb_convex_circle(V(0, 0), 1, &unit_circle), PLUMB_OK);
    return (plumb_cast){ &unit_circle, { a->at, { 1, 0 } }, { 9, 9 } };
}

static int cast(plumb_world *w, const args *a)
{
    plumb_cast c = cast_from(a);
    return plumb_world_cast(w, &c, a->filter, a->no_output ? NULL : cast_hits);
}

static int cast_any(plumb_world *w, const args *a)
{
    plumb_cast c = cast_from(a);
    return plumb_world_cast_any(w, &c, a->filter);
}

static int cast_all(plumb_world *w, const args *a)
{
    plumb_cast c = cast_from(a);
    return plumb_world_cast_all(w, &c, a->filter, a->no_output ? NULL : cast_hits, a->capacity);
}

static int cast_batch(plumb_world *w, const args *a)
{
    plumb_cast c = cast_from(a);
    return plumb_world_cast_batch(w, &c, 1, a->filter, a->no_output ? NULL : cast_hits);
}

static int nearest_all(plumb_world *w, const args *a)
{
    return plumb_world_nearest_all(w, a->at, 9, a->filter, a->no_output ? NULL : near_hits,
                                   a->capacity);
}

static int nearest_batch(plumb_world *w, const args *a)
{
    return plumb_world_nearest_batch(w, &a->at, 1, 9, a->filter, a->no_output ? NULL : near_hits);
}

static const struct {
    int (*call)(plumb_world *world, const args *a);
    const char *name;
    int error; // what it returns
    const char *at, *output;
    bool has_capacity, has_limit;
} queries[] = {
    { ray, "plumb_world_ray", 0, "from", "hit", false, true },
    { ray_all, "plumb_world_ray_all", -1, "from", "hits", true, true },
    { overlap_aabb, "plumb_world_overlap_aabb", -1, "box.min", "shapes", true, false },
    { overlap_convex, "plumb_world_overlap_convex", -1, "transform.p", "shapes", true, true },
    { overlap_point, "plumb_world_overlap_point", -1, "point", "shapes", true, true },
    { nearest, "plumb_world_nearest", 0, "point", "hit", false, true },
    { ray_any, "plumb_world_ray_any", 0, "from", NULL, false, true },
    { ray_batch, "plumb_world_ray_batch", -1, "rays[0].from", "hits", false, true },
    { cast, "plumb_world_cast", 0, "transform.p", "hit", false, true },
    { cast_any, "plumb_world_cast_any", 0, "transform.p", NULL, false, true },
    { cast_all, "plumb_world_cast_all", -1, "transform.p", "hits", true, true },
    { cast_batch, "plumb_world_cast_batch", -1, "casts[0].transform.p", "hits", false, true },
    { nearest_all, "plumb_world_nearest_all", -1, "point", "hits", true, true },
    { nearest_batch, "plumb_world_nearest_batch", -1, "points[0]", "hits", false, true },
};

#define QUERY_COUNT ((int)(sizeof queries / sizeof queries[0]))

static void fill_outputs(void)
{
    memset(ray_hits, 77, sizeof ray_hits);
    memset(shapes, 77, sizeof shapes);
    memset(&near_hit, 77, sizeof near_hit);
    memset(near_hits, 77, sizeof near_hits);
    memset(cast_hits, 77, sizeof cast_hits);
}

static void outputs_untouched(void)
{
    static plumb_ray_hit same_hits[ROOM];
    static plumb_shape same_shapes[ROOM];
    plumb_nearest_hit same;
    memset(same_hits, 77, sizeof same_hits);
    memset(same_shapes, 77, sizeof same_shapes);
    memset(&same, 77, sizeof same);
    assert_memory_equal(ray_hits, same_hits, sizeof same_hits);
    assert_memory_equal(shapes, same_shapes, sizeof same_shapes);
    assert_memory_equal(&near_hit, &same, sizeof same);
    assert_memory_equal(near_hits, &same, sizeof same);
    const unsigned char *bytes = (const unsigned char *)cast_hits;
    for (size_t i = 0; i < sizeof cast_hits; ++i) {
        assert_int_equal(bytes[i], 77);
    }
}

static void refuses(fixture *f, int q, const args *a, plumb_result code, const char *rest)
{
    fill_outputs();
    assert_int_equal(queries[q].call(f->world, a), queries[q].error);
    refused(f, code, queries[q].name, rest);
    outputs_untouched();
}

static void test_right_calls(void **state)
{
    (void)state;
    fixture f;
    setup(&f);
    for (int q = 0; q < QUERY_COUNT; ++q) {
        args a = { .at = V(0, 0), .capacity = 1 };
        assert_int_equal(queries[q].call(f.world, &a), 1);
        assert_int_equal(plumb_world_error(f.world).code, PLUMB_OK);
    }
    assert_true(plumb_same(shapes[0], f.shape) && plumb_same(ray_hits[0].shape, f.shape));
    assert_true(plumb_same(near_hit.shape, f.shape) && plumb_same(near_hit.body, f.ball));
    teardown(&f);
}

static void test_no_world(void **state)
{
    (void)state;
    args a = { .at = V(0, 0), .capacity = 1 };
    for (int q = 0; q < QUERY_COUNT; ++q) {
        fill_outputs();
        assert_int_equal(queries[q].call(NULL, &a), queries[q].error);
        outputs_untouched();
    }
}

static void test_not_finite(void **state)
{
    (void)state;
    fixture f;
    setup(&f);
    for (int q = 0; q < QUERY_COUNT; ++q) {
        char rest[100];
        args a = { .at = { (plumb_real)NAN, 0 }, .capacity = 1 };
        snprintf(rest, sizeof rest, "%s is (nan, 0); it must be finite", queries[q].at);
        refuses(&f, q, &a, PLUMB_E_NOT_FINITE, rest);
        a.at = plumb_v2(2, (plumb_real)-INFINITY);
        snprintf(rest, sizeof rest, "%s is (2, -inf); it must be finite", queries[q].at);
        refuses(&f, q, &a, PLUMB_E_NOT_FINITE, rest);
    }
    teardown(&f);
}

static void test_too_far(void **state)
{
    (void)state;
    fixture f;
    setup(&f);
    for (int q = 0; q < QUERY_COUNT; ++q) {
        args a = { .at = V(0, -1e13), .capacity = 1 };
        char rest[100];
        snprintf(rest, sizeof rest, "%s is (0, -1e+13); each component must be -1e+12 to 1e+12",
                 queries[q].at);
        if (queries[q].has_limit) {
            refuses(&f, q, &a, PLUMB_E_RANGE, rest);
        } else {
            assert_int_equal(queries[q].call(f.world, &a), 1);
        }
        a.at = V(1e12, -1e12); // just near enough
        if (q != 2) {          // of this box that would be the wrong corner
            assert_true(queries[q].call(f.world, &a) >= 0);
            assert_string_equal(f.log, "");
        }
    }
    teardown(&f);
}

static void test_output(void **state)
{
    (void)state;
    fixture f;
    setup(&f);
    for (int q = 0; q < QUERY_COUNT; ++q) {
        args a = { .no_output = true, .capacity = 1 };
        char rest[100];
        if (queries[q].output == NULL) {
            continue;
        }
        snprintf(rest, sizeof rest, "%s is null; it must be given", queries[q].output);
        refuses(&f, q, &a, PLUMB_E_NULL, rest);
        if (queries[q].has_capacity) {
            a.capacity = 0;
            assert_int_equal(queries[q].call(f.world, &a), 1); // only counted
            a.capacity = -1;
            refuses(&f, q, &a, PLUMB_E_RANGE, "capacity is -1; it must be at least 0");
        }
    }
    teardown(&f);
}

static void test_filter(void **state)
{
    (void)state;
    fixture f;
    setup(&f);
    char stale[100];
    snprintf(stale, sizeof stale,
             "filter.ignore_body is stale (%u:%u); it must be a live body or null",
             (unsigned)f.stale.entity.index, (unsigned)f.stale.entity.generation);
    for (int q = 0; q < QUERY_COUNT; ++q) {
        plumb_query_filter filter = { .ignore_body = f.stale };
        args a = { .filter = &filter, .capacity = 1 };
        refuses(&f, q, &a, PLUMB_E_HANDLE, stale);
        filter.ignore_body = (plumb_body){ f.shape.entity };
        refuses(&f, q, &a, PLUMB_E_HANDLE,
                "filter.ignore_body is a shape; it must be a live body or null");
        filter.ignore_body = f.ball;
        assert_int_equal(queries[q].call(f.world, &a), 0);
        filter = (plumb_query_filter){ 0 };
        assert_int_equal(queries[q].call(f.world, &a), 1);
    }
    teardown(&f);
}

//---- what only one of them is given --------------------------------------------------------------

static void test_ray_to(void **state)
{
    (void)state;
    fixture f;
    setup(&f);
    fill_outputs();
    plumb_vec2 wrong = { 0, (plumb_real)NAN };
    assert_false(plumb_world_ray(f.world, V(0, 0), wrong, NULL, ray_hits));
    refused(&f, PLUMB_E_NOT_FINITE, "plumb_world_ray", "to is (0, nan); it must be finite");
    assert_int_equal(plumb_world_ray_all(f.world, V(0, 0), wrong, NULL, ray_hits, 1), -1);
    refused(&f, PLUMB_E_NOT_FINITE, "plumb_world_ray_all", "to is (0, nan); it must be finite");
    assert_false(plumb_world_ray(f.world, V(0, 0), V(2e12, 0), NULL, ray_hits));
    refused(&f, PLUMB_E_RANGE, "plumb_world_ray",
            "to is (2e+12, 0); each component must be -1e+12 to 1e+12");
    outputs_untouched();
    teardown(&f);
}

static void test_box(void **state)
{
    (void)state;
    fixture f;
    setup(&f);
    plumb_aabb box = { { 0, 0 }, { (plumb_real)INFINITY, 0 } };
    assert_int_equal(plumb_world_overlap_aabb(f.world, box, NULL, shapes, 1), -1);
    refused(&f, PLUMB_E_NOT_FINITE, "plumb_world_overlap_aabb",
            "box.max is (inf, 0); it must be finite");
    box = (plumb_aabb){ { -PLUMB_REAL_MAX, -PLUMB_REAL_MAX }, { PLUMB_REAL_MAX, PLUMB_REAL_MAX } };
    assert_int_equal(plumb_world_overlap_aabb(f.world, box, NULL, shapes, 1), 1);
    assert_int_equal(plumb_world_overlap_aabb(f.world, plumb_aabb_empty(), NULL, shapes, 1), 0);
    assert_string_equal(f.log, "");
    teardown(&f);
}

static void test_distance(void **state)
{
    (void)state;
    fixture f;
    setup(&f);
    const struct {
        plumb_real distance;
        plumb_result code;
        const char *rest;
    } cases[] = {
        { 0, PLUMB_E_RANGE, "max_distance is 0; it must be above 0" },
        { -3, PLUMB_E_RANGE, "max_distance is -3; it must be above 0" },
        { (plumb_real)NAN, PLUMB_E_NOT_FINITE, "max_distance is nan; it must be finite" },
        { (plumb_real)INFINITY, PLUMB_E_NOT_FINITE, "max_distance is inf; it must be finite" },
    };
    fill_outputs();
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; ++i) {
        assert_false(plumb_world_nearest(f.world, V(0, 0), cases[i].distance, NULL, &near_hit));
        refused(&f, cases[i].code, "plumb_world_nearest", cases[i].rest);
    }
    outputs_untouched();
    assert_true(plumb_world_nearest(f.world, V(1e12, 0), PLUMB_REAL_MAX, NULL, &near_hit));
    teardown(&f);
}

static void convex_refused(fixture *f, const plumb_convex *convex, plumb_transform t,
                           plumb_result code, const char *rest)
{
    fill_outputs();
    assert_int_equal(plumb_world_overlap_convex(f->world, convex, t, NULL, shapes, 1), -1);
    refused(f, code, "plumb_world_overlap_convex", rest);
    outputs_untouched();
}

static void test_convex(void **state)
{
    (void)state;
    fixture f;
    setup(&f);
    plumb_convex circle;
    assert_int_equal(plumb_convex_circle(V(0, 0), 1, &circle), PLUMB_OK);
    convex_refused(&f, NULL, here, PLUMB_E_NULL, "convex is null; it must be given");
    plumb_convex c = { 0 };
    convex_refused(&f, &c, here, PLUMB_E_RANGE, "convex.count is 0; it must be 1 to 16");
    c.count = 17;
    convex_refused(&f, &c, here, PLUMB_E_RANGE, "convex.count is 17; it must be 1 to 16");
    c = circle;
    c.count = 2;
    c.points[1].y = (plumb_real)NAN;
    convex_refused(&f, &c, here, PLUMB_E_NOT_FINITE,
                   "convex.points[1] is (0, nan); it must be finite");
    c.points[1] = V(2e7, 0);
    convex_refused(&f, &c, here, PLUMB_E_RANGE,
                   "convex.points[1] is (2e+07, 0); each component must be -1e+07 to 1e+07");
    c = circle;
    c.radius = -1;
    convex_refused(&f, &c, here, PLUMB_E_RANGE, "convex.radius is -1; it must be 0 to 1e+07");
    c.radius = (plumb_real)NAN;
    convex_refused(&f, &c, here, PLUMB_E_NOT_FINITE, "convex.radius is nan; it must be finite");
    plumb_transform t = { { 0, 0 }, { 0, 0 } };
    convex_refused(&f, &circle, t, PLUMB_E_RANGE,
                   "transform.q is (0, 0); it must be a unit rotation");
    t.q.s = (plumb_real)INFINITY;
    convex_refused(&f, &circle, t, PLUMB_E_NOT_FINITE,
                   "transform.q is (0, inf); it must be finite");
    c = (plumb_convex){ .count = 2 }; // both points in one place: as good as a point
    assert_int_equal(plumb_world_overlap_convex(f.world, &c, here, NULL, shapes, 1), 1);
    t = (plumb_transform){ { 2, 0 }, { 1, 0 } };
    assert_int_equal(plumb_world_overlap_convex(f.world, &c, t, NULL, shapes, 1), 0);
    teardown(&f);
}

static void cast_refused(fixture *f, const plumb_cast *c, plumb_result code, const char *rest)
{
    char indexed[120];
    const plumb_cast two[2] = { cast_from(&(args){ .at = V(0, 0) }), *c };
    fill_outputs();
    assert_false(plumb_world_cast(f->world, c, NULL, cast_hits));
    refused(f, code, "plumb_world_cast", rest);
    assert_false(plumb_world_cast_any(f->world, c, NULL));
    refused(f, code, "plumb_world_cast_any", rest);
    assert_int_equal(plumb_world_cast_all(f->world, c, NULL, cast_hits, 1), -1);
    refused(f, code, "plumb_world_cast_all", rest);
    snprintf(indexed, sizeof indexed, "casts[1].%s", rest);
    assert_int_equal(plumb_world_cast_batch(f->world, two, 2, NULL, cast_hits), -1);
    refused(f, code, "plumb_world_cast_batch", indexed);
    outputs_untouched();
}

static void test_cast(void **state)
{
    (void)state;
    fixture f;
    setup(&f);
    plumb_cast c = cast_from(&(args){ .at = V(0, 0) });
    c.convex = NULL;
    cast_refused(&f, &c, PLUMB_E_NULL, "convex is null; it must be given");
    plumb_convex bad = { .count = 17 };
    c.convex = &bad;
    cast_refused(&f, &c, PLUMB_E_RANGE, "convex.count is 17; it must be 1 to 16");
    bad = (plumb_convex){ .count = 1, .points = { { (plumb_real)NAN, 0 } } };
    cast_refused(&f, &c, PLUMB_E_NOT_FINITE, "convex.points[0] is (nan, 0); it must be finite");
    bad = (plumb_convex){ .count = 1, .radius = -1 };
    cast_refused(&f, &c, PLUMB_E_RANGE, "convex.radius is -1; it must be 0 to 1e+07");
    c = cast_from(&(args){ .at = V(0, 0) });
    c.transform.q.c = 2;
    cast_refused(&f, &c, PLUMB_E_RANGE, "transform.q is (2, 0); it must be a unit rotation");
    c = cast_from(&(args){ .at = V(0, 0) });
    c.translation.x = (plumb_real)INFINITY;
    cast_refused(&f, &c, PLUMB_E_NOT_FINITE, "translation is (inf, 9); it must be finite");
    c.translation.x = R(2e12);
    cast_refused(&f, &c, PLUMB_E_RANGE,
                 "translation is (2e+12, 9); each component must be -1e+12 to 1e+12");
    assert_false(plumb_world_cast(f.world, NULL, NULL, cast_hits));
    refused(&f, PLUMB_E_NULL, "plumb_world_cast", "cast is null; it must be given");
    teardown(&f);
}

static void test_batch_arguments(void **state)
{
    (void)state;
    fixture f;
    setup(&f);
    plumb_ray rays[2] = { { { 0, 0 }, { 1, 1 } }, { { 0, 0 }, { (plumb_real)NAN, 1 } } };
    plumb_cast one = cast_from(&(args){ .at = V(0, 0) });
    plumb_vec2 point = { 0, 0 };
    plumb_world *w = f.world;
    fill_outputs();
    assert_int_equal(plumb_world_ray_batch(w, rays, 2, NULL, ray_hits), -1);
    refused(&f, PLUMB_E_NOT_FINITE, "plumb_world_ray_batch",
            "rays[1].to is (nan, 1); it must be finite");
    assert_int_equal(plumb_world_ray_batch(w, NULL, 2, NULL, ray_hits), -1);
    refused(&f, PLUMB_E_NULL, "plumb_world_ray_batch", "rays is null; it must be given");
    assert_int_equal(plumb_world_ray_batch(w, rays, -1, NULL, ray_hits), -1);
    refused(&f, PLUMB_E_RANGE, "plumb_world_ray_batch", "count is -1; it must be at least 0");
    assert_int_equal(plumb_world_cast_batch(w, NULL, 1, NULL, cast_hits), -1);
    refused(&f, PLUMB_E_NULL, "plumb_world_cast_batch", "casts is null; it must be given");
    assert_int_equal(plumb_world_cast_batch(w, &one, -2, NULL, cast_hits), -1);
    refused(&f, PLUMB_E_RANGE, "plumb_world_cast_batch", "count is -2; it must be at least 0");
    assert_int_equal(plumb_world_nearest_batch(w, NULL, 1, 1, NULL, near_hits), -1);
    refused(&f, PLUMB_E_NULL, "plumb_world_nearest_batch", "points is null; it must be given");
    assert_int_equal(plumb_world_nearest_batch(w, &point, -1, 1, NULL, near_hits), -1);
    refused(&f, PLUMB_E_RANGE, "plumb_world_nearest_batch", "count is -1; it must be at least 0");
    assert_int_equal(plumb_world_nearest_batch(w, &point, 1, 0, NULL, near_hits), -1);
    refused(&f, PLUMB_E_RANGE, "plumb_world_nearest_batch",
            "max_distance is 0; it must be above 0");
    assert_int_equal(plumb_world_nearest_all(w, point, -1, NULL, near_hits, 1), -1);
    refused(&f, PLUMB_E_RANGE, "plumb_world_nearest_all", "max_distance is -1; it must be above 0");
    outputs_untouched();
    teardown(&f);
}

//---- memory --------------------------------------------------------------------------------------

// However little there is: the right answer, or an error that says so and no loss.
static void test_no_memory(void **state)
{
    (void)state;
    fixture f;
    for (int q = 0; q < QUERY_COUNT; ++q) {
        setup(&f);
        for (int i = 0; i < 149; ++i) {
            plumb_body_desc at = { .type = i % 2 ? PLUMB_STATIC : PLUMB_DYNAMIC };
            plumb_body body = plumb_body_create(f.world, &at);
            plumb_shape_create(f.world, body,
                               &(plumb_shape_desc){ .kind = PLUMB_CIRCLE, .radius = 1 });
        }
        args a = { .capacity = ROOM };
        bool lists = queries[q].has_capacity;
        int expected = lists ? 150 : 1;
        int failures = 0;
        int answer;
        for (f.heap.limit = f.heap.bytes; (answer = queries[q].call(f.world, &a)) != expected;
             f.heap.limit += 256) {
            assert_int_equal(answer, queries[q].error);
            refused(&f, PLUMB_E_MEMORY, queries[q].name, "the allocator returned no memory");
            ++failures;
        }
        assert_true(failures > (lists ? 4 : 0));
        long held = f.heap.bytes;
        assert_int_equal(queries[q].call(f.world, &a), expected);
        assert_int_equal(f.heap.bytes, held); // nothing is kept from query to query
        teardown(&f);
    }
}

// A query that finds little allocates nothing, once the grids are there.
static void test_no_allocation(void **state)
{
    (void)state;
    fixture f;
    setup(&f);
    for (int q = 0; q < QUERY_COUNT; ++q) {
        args a = { .capacity = 1 };
        assert_int_equal(queries[q].call(f.world, &a), 1);
        f.heap.limit = f.heap.bytes;
    }
    teardown(&f);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_right_calls), cmocka_unit_test(test_no_world),
        cmocka_unit_test(test_not_finite),  cmocka_unit_test(test_too_far),
        cmocka_unit_test(test_output),      cmocka_unit_test(test_filter),
        cmocka_unit_test(test_ray_to),      cmocka_unit_test(test_box),
        cmocka_unit_test(test_distance),    cmocka_unit_test(test_convex),
        cmocka_unit_test(test_cast),        cmocka_unit_test(test_batch_arguments),
        cmocka_unit_test(test_no_memory),   cmocka_unit_test(test_no_allocation),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
