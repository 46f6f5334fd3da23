// test_math.c - math.h and matrix.h: identities on seeded random input, closed forms, edge cases.

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>

#include <cmocka.h>

#include "harness/near.h"
#include "harness/random.h"
#include "plumb/math.h"
#include "plumb/matrix.h"

#define TRIALS 2000

// Tolerance for values near 1, after a handful of roundings.
#define TIGHT (16 * (double)PLUMB_REAL_EPSILON)

#define NEAR_V(a, b, tolerance)                                                                    \
    do {                                                                                           \
        plumb_vec2 va = (a), vb = (b);                                                             \
        assert_near(va.x, vb.x, tolerance);                                                        \
        assert_near(va.y, vb.y, tolerance);                                                        \
    } while (0)

static uint32_t random_state;

static plumb_real uniform(double low, double high)
{
    return (plumb_real)sim_uniform(&random_state, low, high);
}

static plumb_vec2 random_vector(void)
{
    plumb_real x = uniform(-10, 10);
    return plumb_v2(x, uniform(-10, 10));
}

static int seed(void **state)
{
    (void)state;
    random_state = 20240607u;
    return 0;
}

static void vectors_follow_the_textbook(void **state)
{
    (void)state;
    plumb_vec2 a = plumb_v2(3, 4), b = plumb_v2(-1, 2);
    NEAR_V(plumb_vec2_add(a, b), plumb_v2(2, 6), 0);
    NEAR_V(plumb_vec2_sub(a, b), plumb_v2(4, 2), 0);
    NEAR_V(plumb_vec2_neg(a), plumb_v2(-3, -4), 0);
    NEAR_V(plumb_vec2_scale(2, a), plumb_v2(6, 8), 0);
    NEAR_V(plumb_vec2_add_scaled(a, 2, b), plumb_v2(1, 8), 0);
    assert_near(plumb_vec2_dot(a, b), 5, 0);
    assert_near(plumb_vec2_cross(a, b), 10, 0);
    assert_near(plumb_vec2_magnitude(a), 5, 0);
    assert_near(plumb_vec2_magnitude_sq(a), 25, 0);
    assert_near(plumb_vec2_distance(a, plumb_v2(0, 0)), 5, 0);
    assert_near(plumb_vec2_distance_sq(a, b), 20, 0);
    NEAR_V(plumb_vec2_left(a), plumb_v2(-4, 3), 0);
    NEAR_V(plumb_vec2_right(a), plumb_v2(4, -3), 0);
    NEAR_V(plumb_vec2_unit(a), plumb_v2(PLUMB_REAL(0.6), PLUMB_REAL(0.8)), TIGHT);
    NEAR_V(plumb_vec2_min(a, b), plumb_v2(-1, 2), 0);
    NEAR_V(plumb_vec2_max(a, b), plumb_v2(3, 4), 0);
    assert_near(plumb_vec2_component(a, plumb_v2(0, 7)), 4, TIGHT);
    NEAR_V(plumb_vec2_project(a, plumb_v2(0, -7)), plumb_v2(0, 4), TIGHT);
    NEAR_V(plumb_vec2_reject(a, plumb_v2(0, -7)), plumb_v2(3, 0), TIGHT);
    NEAR_V(plumb_vec2_reflect(a, plumb_v2(0, 1)), plumb_v2(3, -4), 0);
    NEAR_V(plumb_vec2_lerp(a, b, 0), a, 0);
    NEAR_V(plumb_vec2_lerp(a, b, 1), b, 0);
    NEAR_V(plumb_vec2_lerp(a, b, PLUMB_REAL(0.5)), plumb_v2(1, 3), TIGHT);
}

static void angles_and_components_are_inverse(void **state)
{
    (void)state;
    double quarter = (double)PLUMB_PI / 2;
    assert_near(plumb_vec2_angle(plumb_v2(0, 2)), quarter, TIGHT);
    assert_near(plumb_vec2_angle(plumb_v2(-2, 0)), 2 * quarter, TIGHT);
    assert_near(plumb_vec2_angle(plumb_v2(0, -2)), -quarter, TIGHT);
    assert_near(plumb_vec2_angle_between(plumb_v2(1, 0), plumb_v2(0, -3)), quarter, TIGHT);
    assert_near(plumb_vec2_turn(plumb_v2(1, 0), plumb_v2(0, -3)), -quarter, TIGHT);
    assert_near(plumb_vec2_angle_between(plumb_v2(2, 1), plumb_v2(-2, -1)), 2 * quarter, TIGHT);
    // Far below what an arc cosine could tell from 0: cos(1e-5) is 1 in float.
    assert_near(plumb_vec2_angle_between(plumb_v2(1, 0), plumb_v2(1, PLUMB_REAL(1e-5))), 1e-5,
                1e-11);
    for (int i = 0; i < TRIALS; i++) {
        plumb_vec2 v = random_vector();
        plumb_real m = plumb_vec2_magnitude(v);
        NEAR_V(plumb_vec2_polar(m, plumb_vec2_angle(v)), v, 20 * TIGHT);
        plumb_real turn = uniform(-3, 3);
        plumb_vec2 w = plumb_rot_apply(plumb_rot_make(turn), v);
        assert_near(plumb_vec2_turn(v, w), turn, 4 * TIGHT);
    }
}

static void vectors_without_direction_have_unit_zero(void **state)
{
    (void)state;
    plumb_real m = 7;
    NEAR_V(plumb_vec2_unit(plumb_v2(0, 0)), plumb_v2(0, 0), 0);
    NEAR_V(plumb_vec2_unit_and_magnitude(plumb_v2(0, PLUMB_REAL(1e-19)), &m), plumb_v2(0, 0), 0);
    assert_near(m, 0, 0);
    NEAR_V(plumb_vec2_unit_and_magnitude(plumb_v2(0, PLUMB_REAL(2e-18)), &m), plumb_v2(0, 1),
           TIGHT);
    assert_near(m, 2e-18, 1e-23);
    assert_near(plumb_vec2_component(plumb_v2(1, 2), plumb_v2(0, 0)), 0, 0);
    NEAR_V(plumb_vec2_project(plumb_v2(1, 2), plumb_v2(0, 0)), plumb_v2(0, 0), 0);
    NEAR_V(plumb_vec2_reject(plumb_v2(1, 2), plumb_v2(0, 0)), plumb_v2(1, 2), 0);
    assert_near(plumb_vec2_angle(plumb_v2(0, 0)), 0, 0);
    assert_near(plumb_vec2_angle_between(plumb_v2(0, 0), plumb_v2(1, 0)), 0, 0);
    plumb_rot none = plumb_rot_normalize((plumb_rot){ 0, 0 });
    assert_near(none.c, 1, 0);
    assert_near(none.s, 0, 0);
}

static void projection_splits_a_vector(void **state)
{
    (void)state;
    for (int i = 0; i < TRIALS; i++) {
        plumb_vec2 v = random_vector(), d = random_vector();
        plumb_vec2 along = plumb_vec2_project(v, d), across = plumb_vec2_reject(v, d);
        NEAR_V(plumb_vec2_add(along, across), v, 20 * TIGHT);
        assert_near(plumb_vec2_cross(along, plumb_vec2_unit(d)), 0, 20 * TIGHT);
        assert_near(plumb_vec2_dot(across, plumb_vec2_unit(d)), 0, 20 * TIGHT);
        assert_near(plumb_vec2_magnitude(plumb_vec2_unit(v)), 1, TIGHT);
        assert_near(plumb_vec2_component(v, d), plumb_vec2_dot(along, plumb_vec2_unit(d)),
                    20 * TIGHT);
        plumb_vec2 mirrored = plumb_vec2_reflect(v, plumb_vec2_unit(d));
        assert_near(plumb_vec2_magnitude(mirrored), plumb_vec2_magnitude(v), 40 * TIGHT);
    }
}

static void scalars_keep_their_promises(void **state)
{
    (void)state;
    plumb_real zero = 0;
    plumb_real not_a_number = zero / zero, infinite = 1 / zero;
    assert_true(plumb_is_finite(PLUMB_REAL_MAX) && plumb_is_finite(-PLUMB_REAL_MAX));
    assert_false(plumb_is_finite(not_a_number));
    assert_false(plumb_is_finite(infinite) || plumb_is_finite(-infinite));
    assert_false(plumb_vec2_is_finite(plumb_v2(0, infinite)));
    assert_false(plumb_vec2_is_finite(plumb_v2(not_a_number, 0)));
    assert_true(plumb_vec2_is_finite(plumb_v2(1, 2)));
    assert_near(plumb_clamp(5, 1, 3), 3, 0);
    assert_near(plumb_clamp(-5, 1, 3), 1, 0);
    assert_near(plumb_clamp(2, 1, 3), 2, 0);
    assert_near(plumb_clamp(not_a_number, 1, 3), 1, 0);
    assert_near(plumb_min(not_a_number, 3), 3, 0);
    assert_near(plumb_max(not_a_number, 3), 3, 0);
    assert_near(plumb_abs(-3), 3, 0);
    assert_near(plumb_sqrt(2), 1.4142135623730951, TIGHT);
    assert_near(plumb_radians(180), PLUMB_PI, TIGHT);
    assert_near(plumb_degrees(PLUMB_PI / 2), 90, 100 * TIGHT);
    for (int i = 0; i < TRIALS; i++) {
        plumb_real d = uniform(-720, 720);
        assert_near(plumb_degrees(plumb_radians(d)), d, 720 * TIGHT);
    }
}

static plumb_mat2 random_mat2(void)
{
    plumb_vec2 a = random_vector(), b = random_vector();
    return plumb_mat2_rows(a.x, a.y, b.x, b.y);
}

static void matrices_multiply_and_invert(void **state)
{
    (void)state;
    plumb_mat2 a = plumb_mat2_rows(1, 2, 3, 4), b = plumb_mat2_rows(5, 6, 7, 8);
    plumb_mat2 p = plumb_mat2_mul(a, b);
    assert_near(p.m[0][0], 19, 0);
    assert_near(p.m[0][1], 22, 0);
    assert_near(p.m[1][0], 43, 0);
    assert_near(p.m[1][1], 50, 0);
    assert_near(plumb_mat2_determinant(a), -2, 0);
    assert_near(plumb_mat2_transpose(a).m[0][1], 3, 0);
    plumb_mat2 untouched = b;
    assert_false(plumb_mat2_inverse(plumb_mat2_rows(1, 2, 2, 4), &untouched));
    assert_memory_equal(&untouched, &b, sizeof b);
    for (int i = 0; i < TRIALS; i++) {
        plumb_mat2 m = random_mat2(), n = random_mat2(), back = plumb_mat2_identity();
        plumb_vec2 v = random_vector();
        NEAR_V(plumb_mat2_apply(plumb_mat2_mul(m, n), v),
               plumb_mat2_apply(m, plumb_mat2_apply(n, v)), 4e3 * TIGHT);
        if (plumb_abs(plumb_mat2_determinant(m)) > 5) {
            assert_true(plumb_mat2_inverse(m, &back));
            NEAR_V(plumb_mat2_apply(back, plumb_mat2_apply(m, v)), v, 1e3 * TIGHT);
        }
    }
}

static void homogeneous_transforms_and_inverses(void **state)
{
    (void)state;
    NEAR_V(plumb_mat3_apply(plumb_mat3_translation(plumb_v2(2, 3)), plumb_v2(1, 1)), plumb_v2(3, 4),
           0);
    NEAR_V(plumb_mat3_apply(plumb_mat3_rotation(PLUMB_PI / 2), plumb_v2(1, 0)), plumb_v2(0, 1),
           TIGHT);
    NEAR_V(
        plumb_mat3_apply(plumb_mat3_rotation_about(plumb_v2(1, 1), PLUMB_PI / 2), plumb_v2(2, 1)),
        plumb_v2(1, 2), TIGHT);
    NEAR_V(plumb_mat3_apply(plumb_mat3_scale(2, 3), plumb_v2(1, 1)), plumb_v2(2, 3), 0);
    NEAR_V(plumb_mat3_apply(plumb_mat3_scale_about(plumb_v2(1, 1), 2, 3), plumb_v2(2, 2)),
           plumb_v2(3, 4), 0);
    NEAR_V(plumb_mat3_apply_vector(plumb_mat3_translation(plumb_v2(2, 3)), plumb_v2(1, 1)),
           plumb_v2(1, 1), 0);
    plumb_mat3 untouched = plumb_mat3_identity();
    assert_false(plumb_mat3_affine_inverse(plumb_mat3_scale(0, 1), &untouched));
    assert_near(untouched.m[0][0], 1, 0);
    for (int i = 0; i < TRIALS; i++) {
        plumb_vec2 c = random_vector(), t = random_vector(), v = random_vector();
        plumb_real angle = uniform(-7, 7);
        plumb_mat3 turn = plumb_mat3_rotation_about(c, angle);
        // About a point is: there, turn, and back again.
        plumb_mat3 long_way = plumb_mat3_mul(
            plumb_mat3_translation(c),
            plumb_mat3_mul(plumb_mat3_rotation(angle), plumb_mat3_translation(plumb_vec2_neg(c))));
        NEAR_V(plumb_mat3_apply(turn, v), plumb_mat3_apply(long_way, v), 60 * TIGHT);
        NEAR_V(plumb_mat3_apply(turn, c), c, 60 * TIGHT);
        plumb_mat3 rigid = plumb_mat3_mul(turn, plumb_mat3_translation(t));
        NEAR_V(plumb_mat3_apply(plumb_mat3_rigid_inverse(rigid), plumb_mat3_apply(rigid, v)), v,
               90 * TIGHT);
        NEAR_V(plumb_mat3_apply(plumb_mat3_rotation_about(c, -angle), plumb_mat3_apply(turn, v)), v,
               90 * TIGHT);
        plumb_mat3 any = plumb_mat3_mul(rigid, plumb_mat3_scale_about(c, 3, PLUMB_REAL(-0.5)));
        plumb_mat3 back = plumb_mat3_identity();
        assert_true(plumb_mat3_affine_inverse(any, &back));
        NEAR_V(plumb_mat3_apply(back, plumb_mat3_apply(any, v)), v, 400 * TIGHT);
    }
}

static void rotations_form_a_group(void **state)
{
    (void)state;
    for (int i = 0; i < TRIALS; i++) {
        plumb_real a = uniform(-3.14159, 3.14159), b = uniform(-3.14159, 3.14159);
        plumb_rot qa = plumb_rot_make(a), qb = plumb_rot_make(b);
        plumb_vec2 v = random_vector();
        assert_near(plumb_rot_angle(qa), a, TIGHT);
        plumb_rot sum = plumb_rot_mul(qa, qb), difference = plumb_rot_inv_mul(qa, qb);
        plumb_rot want = plumb_rot_make(a + b);
        assert_near(sum.c, want.c, TIGHT);
        assert_near(sum.s, want.s, TIGHT);
        want = plumb_rot_make(b - a);
        assert_near(difference.c, want.c, TIGHT);
        assert_near(difference.s, want.s, TIGHT);
        NEAR_V(plumb_rot_inv_apply(qa, plumb_rot_apply(qa, v)), v, 10 * TIGHT);
        NEAR_V(plumb_rot_apply(plumb_rot_inverse(qa), v), plumb_rot_inv_apply(qa, v), 0);
        NEAR_V(plumb_rot_apply(qa, v), plumb_mat2_apply(plumb_mat2_rotation(a), v), 0);
        plumb_rot q = plumb_rot_from_direction(v);
        assert_near(plumb_rot_angle(q), plumb_vec2_angle(v), TIGHT);
        assert_true(plumb_rot_is_unit(q));
    }
    assert_false(plumb_rot_is_unit((plumb_rot){ 1, PLUMB_REAL(0.1) }));
}

static void integration_is_exact_and_stays_unit(void **state)
{
    (void)state;
    for (int i = 0; i < TRIALS; i++) {
        plumb_real a = uniform(-3, 3), d = i % 2 == 0 ? uniform(-0.6, 0.6) : uniform(-9, 9);
        plumb_rot q = plumb_rot_integrate(plumb_rot_make(a), d);
        plumb_rot want = plumb_rot_mul(plumb_rot_make(a), plumb_rot_make(d));
        assert_near(q.c, want.c, TIGHT);
        assert_near(q.s, want.s, TIGHT);
    }
    for (int i = 0; i < TRIALS; i++) {
        plumb_real d = PLUMB_ROT_SMALL_TURN * uniform(-1, 1);
        plumb_rot q = plumb_rot_integrate(plumb_rot_identity(), d), want = plumb_rot_make(d);
        assert_near(q.c, want.c, 2 * (double)PLUMB_REAL_EPSILON);
        assert_near(q.s, want.s, 2 * (double)PLUMB_REAL_EPSILON);
    }
    // A million substeps: a wheel at 8 rad/s, h = 1/240 s; dyadic, so that the sum is exact.
    plumb_rot q = plumb_rot_identity();
    plumb_real d = PLUMB_REAL(0.03125);
    for (int i = 0; i < 1000000; i++) {
        q = plumb_rot_integrate(q, d);
    }
    assert_near(q.c * q.c + q.s * q.s, 1, TIGHT);
    plumb_rot want = plumb_rot_make(plumb_angle_wrap(31250));
    // Each step may be off by a rounding: at most a million of them, in practice their root.
    assert_near(plumb_rot_angle(plumb_rot_inv_mul(want, q)), 0, 1e5 * (double)PLUMB_REAL_EPSILON);
}

static void transforms_compose(void **state)
{
    (void)state;
    plumb_transform none = plumb_transform_identity();
    NEAR_V(plumb_transform_apply(none, plumb_v2(1, 2)), plumb_v2(1, 2), 0);
    for (int i = 0; i < TRIALS; i++) {
        plumb_transform a = plumb_transform_make(random_vector(), uniform(-4, 4));
        plumb_transform b = plumb_transform_make(random_vector(), uniform(-4, 4));
        plumb_vec2 v = random_vector();
        NEAR_V(plumb_transform_inv_apply(a, plumb_transform_apply(a, v)), v, 60 * TIGHT);
        NEAR_V(plumb_transform_apply(plumb_transform_mul(a, b), v),
               plumb_transform_apply(a, plumb_transform_apply(b, v)), 60 * TIGHT);
        NEAR_V(plumb_transform_apply(plumb_transform_inv_mul(a, b), v),
               plumb_transform_inv_apply(a, plumb_transform_apply(b, v)), 60 * TIGHT);
        NEAR_V(plumb_transform_apply(plumb_transform_inverse(a), v),
               plumb_transform_inv_apply(a, v), 60 * TIGHT);
        NEAR_V(plumb_mat3_apply(plumb_mat3_from_transform(a), v), plumb_transform_apply(a, v),
               10 * TIGHT);
    }
}

static void boxes_unite_and_overlap(void **state)
{
    (void)state;
    plumb_aabb a = plumb_aabb_make(plumb_v2(0, 0), plumb_v2(2, 1));
    plumb_aabb b = plumb_aabb_make(plumb_v2(2, 1), plumb_v2(3, 3));
    plumb_aabb c = plumb_aabb_make(plumb_v2(PLUMB_REAL(2.5), 0), plumb_v2(3, PLUMB_REAL(0.5)));
    assert_true(plumb_aabb_overlap(a, b)); // a corner is shared
    assert_false(plumb_aabb_overlap(a, c));
    assert_false(plumb_aabb_overlap(b, c));
    plumb_aabb u = plumb_aabb_union(a, b);
    assert_true(plumb_aabb_contains(u, a) && plumb_aabb_contains(u, b));
    assert_true(plumb_aabb_contains(u, c) && !plumb_aabb_contains(a, u));
    NEAR_V(plumb_aabb_center(u), plumb_v2(PLUMB_REAL(1.5), PLUMB_REAL(1.5)), 0);
    NEAR_V(plumb_aabb_extent(u), plumb_v2(PLUMB_REAL(1.5), PLUMB_REAL(1.5)), 0);
    assert_true(plumb_aabb_contains_point(a, plumb_v2(2, 0)));
    assert_false(plumb_aabb_contains_point(a, plumb_v2(2, PLUMB_REAL(1.1))));
    plumb_aabb e = plumb_aabb_empty();
    assert_true(plumb_aabb_is_empty(e) && !plumb_aabb_is_empty(a));
    plumb_aabb same = plumb_aabb_union(e, a);
    assert_memory_equal(&same, &a, sizeof a);
    plumb_aabb point = plumb_aabb_add_point(e, plumb_v2(4, 5));
    NEAR_V(point.min, plumb_v2(4, 5), 0);
    NEAR_V(point.max, plumb_v2(4, 5), 0);
    assert_true(plumb_aabb_is_empty(plumb_aabb_expand(point, -1)));
    NEAR_V(plumb_aabb_expand(point, 1).max, plumb_v2(5, 6), 0);
}

static void the_screen_is_upside_down(void **state)
{
    (void)state;
    plumb_view view = { { 400, 300 }, 50 };
    NEAR_V(plumb_view_to_screen(view, plumb_v2(0, 0)), plumb_v2(400, 300), 0);
    NEAR_V(plumb_view_to_screen(view, plumb_v2(1, 2)), plumb_v2(450, 200), 0);
    NEAR_V(plumb_view_to_world(view, plumb_v2(450, 200)), plumb_v2(1, 2), 0);
    NEAR_V(plumb_view_vector_to_screen(view, plumb_v2(1, 2)), plumb_v2(50, -100), 0);
    for (int i = 0; i < TRIALS; i++) {
        plumb_vec2 p = random_vector();
        plumb_vec2 s = plumb_view_to_screen(view, p);
        NEAR_V(plumb_view_to_world(view, s), p, 20 * TIGHT);
        NEAR_V(plumb_mat3_apply(plumb_mat3_view(view), p), s, 0);
        plumb_vec2 v = plumb_view_vector_to_screen(view, p);
        NEAR_V(plumb_view_vector_to_world(view, v), p, 20 * TIGHT);
        assert_near(plumb_vec2_angle(v), plumb_view_angle(plumb_vec2_angle(p)), TIGHT);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup(vectors_follow_the_textbook, seed),
        cmocka_unit_test_setup(angles_and_components_are_inverse, seed),
        cmocka_unit_test_setup(vectors_without_direction_have_unit_zero, seed),
        cmocka_unit_test_setup(projection_splits_a_vector, seed),
        cmocka_unit_test_setup(scalars_keep_their_promises, seed),
        cmocka_unit_test_setup(matrices_multiply_and_invert, seed),
        cmocka_unit_test_setup(homogeneous_transforms_and_inverses, seed),
        cmocka_unit_test_setup(rotations_form_a_group, seed),
        cmocka_unit_test_setup(integration_is_exact_and_stays_unit, seed),
        cmocka_unit_test_setup(transforms_compose, seed),
        cmocka_unit_test_setup(boxes_unite_and_overlap, seed),
        cmocka_unit_test_setup(the_screen_is_upside_down, seed),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
