// test_query_overlap.c - overlaps and the nearest shape, against a model that asks every piece.
#include "query_model.h"

static void test_overlaps(void **state)
{
    (void)state;
    for (uint32_t seed = 1; seed <= 6; ++seed) {
        double reach = sqrt(60.0 * seed) * spread(0.5, 4);
        plumb_world *world = random_world(seed + 40, 60 * (int)seed, reach, 0.1, 1);
        overlaps_of_all_kinds(world, 300, 1.2 * reach, 0.5, NULL);
        plumb_aabb all = { { -PLUMB_REAL_MAX, -PLUMB_REAL_MAX },
                           { PLUMB_REAL_MAX, PLUMB_REAL_MAX } };
        assert_int_equal(check_aabb(world, all, NULL), (int)world->shape_count);
        plumb_aabb none = { { 1, 1 }, { -1, -1 } };
        assert_int_equal(plumb_world_overlap_aabb(world, none, NULL, NULL, 0), 0);
        plumb_world_destroy(world);
    }
}

static void test_overlaps_mixed_sizes(void **state)
{
    (void)state;
    for (uint32_t seed = 1; seed <= 5; ++seed) {
        plumb_world *world = make_world(seed + 60);
        for (int i = 0; i < 150; ++i) {
            add_random(world, spread(0.1, 2000), 0.01, 300);
        }
        overlaps_of_all_kinds(world, 60, 2500, 100, NULL);
        overlaps_of_all_kinds(world, 60, 2, 0.1, NULL);
        plumb_world_destroy(world);
    }
}

static void test_nearest(void **state)
{
    (void)state;
    plumb_world *world = make_world(3);
    plumb_nearest_hit hit;
    assert_false(plumb_world_nearest(world, V(0, 0), PLUMB_REAL_MAX, NULL, &hit)); // empty
    plumb_body ball = add_body(world, PLUMB_DYNAMIC, V(10, 0), 2);
    plumb_shape circle = add_shape(world, ball, PLUMB_CIRCLE, 2);
    assert_true(plumb_world_nearest(world, V(0, 0), PLUMB_REAL_MAX, NULL, &hit));
    assert_true(plumb_same(hit.shape, circle) && plumb_same(hit.body, ball));
    assert_near(hit.distance, 8, ROUNDED(1e-5));
    assert_near(hit.point.x, 8, ROUNDED(1e-5));
    assert_false(plumb_world_nearest(world, V(0, 0), R(7.99), NULL, &hit));
    assert_true(plumb_world_nearest(world, V(0, 0), R(8.01), NULL, &hit));
    assert_true(plumb_world_nearest(world, V(10, 0.5), R(0.001), NULL, &hit)); // inside
    assert_near(hit.distance, -1.5, ROUNDED(1e-5));
    assert_near(hit.point.y, 2, ROUNDED(1e-5));
    assert_true(plumb_world_nearest(world, V(1e8, 1e8), PLUMB_REAL_MAX, NULL, &hit));
    assert_near((double)hit.distance / 1.414e8, 1, 1e-3);
    // Far more boxes than cells are looked at, and the nearest is in the last.
    for (int i = 0; i < 300; ++i) {
        add_random(world, 3, 0.05, 0.2);
    }
    for (int i = 0; i < 200; ++i) {
        check_nearest(world, place(spread(1, 1e4)), PLUMB_REAL_MAX, NULL);
    }
    plumb_world_destroy(world);
}

// The test of two convex shapes alone, with sizes and distances of all orders.
static void test_rounds(void **state)
{
    (void)state;
    random_state = 99;
    int told[3] = { 0, 0, 0 };
    for (int i = 0; i < 60000; ++i) {
        plumb_convex a = random_convex(spread(1e-2, 10));
        plumb_convex b = random_convex(spread(1e-2, 10));
        double reach = spread(0.1, 10);
        plumb_transform ta = plumb_transform_make(place(reach), R(uniform(-4, 4)));
        plumb_transform tb = plumb_transform_make(place(reach), R(uniform(-4, 4)));
        pl_round ra, rb;
        pl_round_make(&a, ta, ta.p, &ra);
        pl_round_make(&b, tb, ta.p, &rb);
        int expected = expect_overlap(&a, ta, &b, tb);
        bool overlap = pl_rounds_overlap(&ra, &rb);
        assert_true(overlap == pl_rounds_overlap(&rb, &ra));
        if (expected != 0 && overlap != (expected == 1)) {
            fail_msg("case %d: %d corners and %d corners, overlap %d", i, a.count, b.count,
                     overlap);
        }
        ++told[expected + 1];
    }
    assert_true(told[0] > 10000 && told[2] > 10000 && told[1] < 10);
}

// Cases whose answer is exact: touching counts, segments in line, crosses, points on points.
static void test_rounds_exact(void **state)
{
    (void)state;
    const struct {
        double a[5], b[5]; // x, y of both ends (equal: circle), radius
        bool overlap;
    } cases[] = {
        { { 0, 0, 0, 0, 1 }, { 3, 0, 3, 0, 2 }, true },       // circles touch
        { { 0, 0, 0, 0, 1 }, { 3, 0, 3, 0, 1.9375 }, false }, //
        { { 0, 0, 0, 0, 1 }, { 0, 0, 0, 0, 1 }, true },       // the same
        { { 0, 0, 2, 0, 0 }, { 2, 0, 4, 0, 0 }, true },       // end to end
        { { 0, 0, 2, 0, 0 }, { 3, 0, 4, 0, 0 }, false },      // in line
        { { 0, 0, 2, 0, 0 }, { 3, 0, 4, 0, 1 }, true },       //
        { { 0, 0, 2, 0, 0 }, { 1, 0, 4, 0, 0 }, true },       // in line, overlapping
        { { 0, 0, 2, 2, 0 }, { 0, 2, 2, 0, 0 }, true },       // cross
        { { 0, 0, 2, 2, 0 }, { 3, 0, 2, 1, 0 }, false },      // would cross if longer
        { { 0, 0, 4, 0, 0 }, { 2, 0, 2, 3, 0 }, true },       // T
        { { 0, 0, 4, 0, 0 }, { 2, 0.0625, 2, 3, 0 }, false }, //
        { { 0, 0, 4, 0, 1 }, { 1, 3, 3, 3, 2 }, true },       // parallel capsules touch
        { { 0, 0, 4, 0, 1 }, { 1, 3, 3, 3, 1.9375 }, false }, //
        { { 0, 0, 4, 0, 0 }, { 4, 0, 4, 0, 1 }, true },       // circle about an end
        { { 0, 0, 4, 0, 0 }, { 7, 4, 7, 4, 5 }, true },       // 3, 4, 5
        { { 0, 0, 4, 0, 0 }, { 7, 4, 7, 4, 4.9375 }, false }, //
    };
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; ++i) {
        pl_round rounds[2];
        for (int k = 0; k < 2; ++k) {
            const double *c = k == 0 ? cases[i].a : cases[i].b;
            plumb_convex convex = { .points = { V(c[0], c[1]), V(c[2], c[3]) }, .radius = R(c[4]) };
            convex.count = c[0] == c[2] && c[1] == c[3] ? 1 : 2;
            pl_round_make(&convex, plumb_transform_identity(), V(0, 0), &rounds[k]);
        }
        if (pl_rounds_overlap(&rounds[0], &rounds[1]) != cases[i].overlap ||
            pl_rounds_overlap(&rounds[1], &rounds[0]) != cases[i].overlap) {
            fail_msg("case %d", (int)i);
        }
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_overlaps),     cmocka_unit_test(test_overlaps_mixed_sizes),
        cmocka_unit_test(test_nearest),      cmocka_unit_test(test_rounds),
        cmocka_unit_test(test_rounds_exact),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
