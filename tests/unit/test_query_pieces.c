// test_query_pieces.c - queries of shapes that consist of several pieces, and far from the origin.
#include "query_model.h"

#define NO_SHAPE ((plumb_shape)PLUMB_NULL_INIT)

//---- shapes of several pieces --------------------------------------------------------------------
static const plumb_vec2 bowl[] = { { -3, 0 }, { 3, 0 },  { 3, 4 },  { 2, 4 },
                                   { 2, 1 },  { -2, 1 }, { -2, 4 }, { -3, 4 } };

static plumb_real distance_to_bowl(plumb_vec2 local)
{
    plumb_real best = PLUMB_REAL_MAX;
    for (int i = 0; i < 8; ++i) {
        plumb_vec2 a = bowl[i], d = plumb_vec2_sub(bowl[(i + 1) % 8], a);
        plumb_real t = plumb_vec2_dot(plumb_vec2_sub(local, a), d) / plumb_vec2_magnitude_sq(d);
        plumb_vec2 at = plumb_vec2_add_scaled(a, plumb_clamp(t, 0, 1), d);
        best = plumb_min(best, plumb_vec2_distance(at, local));
    }
    return plumb_outline_contains(bowl, 8, local) ? -best : best;
}

// A concave outline behaves as one shape: inner cuts are neither surface nor gap.
static void test_outline(void **state)
{
    (void)state;
    plumb_world *world = make_world(9);
    for (int turned = 0; turned < 20; ++turned) {
        plumb_body body = add_body(world, (plumb_body_type)(turned % 3), place(50), uniform(-4, 4));
        plumb_shape_desc desc = { .kind = PLUMB_OUTLINE, .points = bowl, .count = 8 };
        plumb_shape shape = plumb_shape_create(world, body, &desc);
        assert_true(plumb_shape_piece_count(world, shape) > 1);
        plumb_transform t = plumb_body_transform(world, body);
        for (int i = 0; i < 500; ++i) {
            plumb_vec2 local = V(uniform(-4, 4), uniform(-1, 5));
            plumb_vec2 at = plumb_transform_apply(t, local);
            plumb_nearest_hit near;
            assert_true(plumb_world_nearest(world, at, 99, NULL, &near));
            plumb_real expected = distance_to_bowl(local);
            assert_near(near.distance, expected, ROUNDED(2e-4));
            assert_near(plumb_vec2_distance(near.point, at), plumb_abs(expected), ROUNDED(2e-4));
            plumb_ray_hit hit;
            plumb_vec2 to = plumb_transform_apply(t, V(0, 0.5));
            assert_true(plumb_world_ray(world, at, to, NULL, &hit));
            if (expected > R(0.001)) { // from outside: the surface, facing the ray
                plumb_vec2 met = plumb_transform_inv_apply(t, hit.point);
                assert_near(distance_to_bowl(met), 0, ROUNDED(2e-4));
                assert_true(plumb_vec2_dot(hit.normal, plumb_vec2_sub(to, at)) < 0);
            } else if (expected < R(-0.001)) {
                assert_true(hit.fraction == 0);
            }
        }
        assert_int_equal(plumb_body_destroy(world, body), PLUMB_OK);
    }
    plumb_world_destroy(world);
}

// A point on a cut is in the shape, whichever of its pieces rounding leaves it out of.
static void test_points_on_cuts(void **state)
{
    (void)state;
    plumb_world *world = make_world(4);
    int count = 0;
    for (int k = 0; k < 300; ++k) {
        plumb_body body = add_body(world, PLUMB_STATIC, place(30), uniform(-4, 4));
        plumb_vec2 points[14];
        const int corners = (int)uniform(5, 14.999);
        for (int i = 0; i < corners; ++i) {
            points[i] =
                plumb_vec2_polar(R(uniform(0.3, 1.2)), R(6.28 * (i + uniform(0, 0.5)) / corners));
        }
        const plumb_shape_desc desc = { .kind = PLUMB_OUTLINE, .points = points, .count = corners };
        plumb_shape shape = plumb_shape_create(world, body, &desc), found;
        assert_false(plumb_is_null(shape));
        for (int i = 0; i < plumb_shape_piece_count(world, shape); ++i) {
            plumb_convex piece;
            uint32_t cuts;
            assert_int_equal(plumb_shape_piece(world, shape, i, &piece, &cuts), PLUMB_OK);
            for (int e = 0; e < 8 * piece.count; ++e) {
                const plumb_vec2 a = piece.points[e / 8];
                const plumb_vec2 b = piece.points[(e / 8 + 1) % piece.count];
                if ((cuts >> (e / 8) & 1u) != 0) {
                    const plumb_vec2 at = plumb_body_world_point(
                        world, body, plumb_vec2_lerp(a, b, R(uniform(0.1, 0.9))));
                    assert_true(plumb_shape_contains(world, shape, at));
                    assert_int_equal(plumb_world_overlap_point(world, at, NULL, &found, 1), 1);
                    ++count;
                }
            }
        }
        assert_int_equal(plumb_body_destroy(world, body), PLUMB_OK);
    }
    assert_true(count > 1000);
    plumb_world_destroy(world);
}

// Points and rays on the inner cuts themselves, where rounding decides which piece they are in.
static void test_inner_cuts(void **state)
{
    (void)state;
    plumb_world *world = make_world(10);
    for (int turned = 0; turned < 50; ++turned) {
        plumb_body body = add_body(world, PLUMB_STATIC, place(30), uniform(-4, 4));
        plumb_shape_desc desc = { .kind = PLUMB_OUTLINE, .points = bowl, .count = 8 };
        plumb_shape shape = plumb_shape_create(world, body, &desc);
        plumb_transform t = plumb_body_transform(world, body);
        for (int piece = 0; piece < plumb_shape_piece_count(world, shape); ++piece) {
            plumb_convex convex;
            uint32_t cuts;
            assert_int_equal(plumb_shape_piece(world, shape, piece, &convex, &cuts), PLUMB_OK);
            for (int k = 0; k < convex.count; ++k) {
                plumb_vec2 a = convex.points[k], b = convex.points[(k + 1) % convex.count];
                for (int i = 1; i < 40 && (cuts >> k & 1u); ++i) {
                    plumb_vec2 local = plumb_vec2_lerp(a, b, R(i / 40.0));
                    plumb_vec2 at = plumb_transform_apply(t, local);
                    plumb_ray_hit hit;
                    plumb_nearest_hit near;
                    assert_int_equal(plumb_world_overlap_point(world, at, NULL, NULL, 0), 1);
                    assert_true(plumb_world_ray(world, at, V(99, 99), NULL, &hit));
                    assert_true(hit.fraction == 0);
                    assert_true(plumb_world_nearest(world, at, 1, NULL, &near));
                    assert_near(near.distance, distance_to_bowl(local), ROUNDED(2e-4));
                }
                if (cuts >> k & 1u) { // along the cut, from outside
                    plumb_vec2 from = plumb_vec2_lerp(a, b, -20), to = plumb_vec2_lerp(a, b, 20);
                    plumb_ray_hit hit;
                    assert_true(plumb_world_ray(world, plumb_transform_apply(t, from),
                                                plumb_transform_apply(t, to), NULL, &hit));
                }
            }
        }
        assert_int_equal(plumb_body_destroy(world, body), PLUMB_OK);
    }
    plumb_world_destroy(world);
}

static void test_chain(void **state)
{
    (void)state;
    plumb_world *world = make_world(11);
    plumb_body ground = add_body(world, PLUMB_STATIC, V(0, 0), 0);
    plumb_vec2 points[200];
    for (int i = 0; i < 200; ++i) {
        points[i] = V(i, i % 2);
    }
    plumb_shape_desc desc = { .kind = PLUMB_CHAIN, .points = points, .count = 200 };
    plumb_shape chain = plumb_shape_create(world, ground, &desc);
    plumb_shape shapes[4] = { NO_SHAPE };
    plumb_ray_hit hits[4];
    assert_int_equal(
        plumb_world_overlap_aabb(world, (plumb_aabb){ { -9, -9 }, { 999, 9 } }, NULL, shapes, 4),
        1);
    assert_true(plumb_same(shapes[0], chain));
    assert_int_equal(plumb_world_ray_all(world, V(-1, 0.5), V(300, 0.5), NULL, hits, 4), 1);
    assert_near(hits[0].point.x, 0.5, ROUNDED(1e-3));
    // Through every corner from above and below: nothing slips through.
    for (int i = 0; i < 200; ++i) {
        assert_int_equal(plumb_world_ray_all(world, V(i, 5), V(i, -5), NULL, hits, 4), 1);
        assert_int_equal(plumb_world_ray_all(world, V(i, -5), V(i, 5), NULL, hits, 4), 1);
        assert_true(hits[0].normal.y < 0 || hits[0].normal.x != 0);
    }
    check_a_few(world, 20);
    plumb_world_destroy(world);
}

static void test_far_away(void **state)
{
    (void)state;
    double far = (double)PLUMB_REAL_EPSILON < 1e-10 ? 9e8 : 1e5;
    plumb_world *world = make_world(12);
    for (int i = 0; i < 150; ++i) {
        plumb_body body = add_random(world, 10, 0.2, 1);
        plumb_vec2 at = plumb_vec2_add(V(-far, far), place(10));
        assert_int_equal(plumb_body_teleport(world, body, at, 1), PLUMB_OK);
    }
    int met = 0;
    for (int i = 0; i < 500; ++i) {
        plumb_vec2 from = plumb_vec2_add(V(-far, far), place(14));
        plumb_vec2 to = plumb_vec2_add(V(-far, far), place(14));
        met += check_ray(world, from, to, NULL) > 0;
        check_point(world, to, NULL);
        check_nearest(world, from, PLUMB_REAL_MAX, NULL);
        check_ray(world, i % 2 ? V(0, 0) : V(far, far), to, NULL); // long
    }
    assert_true(met > 100);
    plumb_world_destroy(world);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_outline),        cmocka_unit_test(test_inner_cuts),
        cmocka_unit_test(test_points_on_cuts), cmocka_unit_test(test_chain),
        cmocka_unit_test(test_far_away),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
