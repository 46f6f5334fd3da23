// test_api_between.c - distance, cast and impact of two convex shapes without a world, against brute force over all
// separating directions that can matter.
#include "unit/geometry_fixture.h"

// A shape where it is, in double.
typedef struct core {
    double x[PLUMB_POLYGON_MAX_VERTICES], y[PLUMB_POLYGON_MAX_VERTICES], radius;
    int count;
} core;

static core place(const plumb_convex *s, plumb_transform t)
{
    core c = { .count = s->count, .radius = (double)s->radius };
    for (int i = 0; i < c.count; ++i) {
        const double x = (double)s->points[i].x, y = (double)s->points[i].y;
        c.x[i] = (double)t.p.x + (double)t.q.c * x - (double)t.q.s * y;
        c.y[i] = (double)t.p.y + (double)t.q.s * x + (double)t.q.c * y;
    }
    return c;
}

// By how much b lies beyond a along a direction.
static double beyond(const core *a, const core *b, double nx, double ny)
{
    double most = -HUGE_VAL, least = HUGE_VAL;
    for (int i = 0; i < a->count; ++i) {
        most = fmax(most, nx * a->x[i] + ny * a->y[i]);
    }
    for (int i = 0; i < b->count; ++i) {
        least = fmin(least, nx * b->x[i] + ny * b->y[i]);
    }
    return least - most - a->radius - b->radius;
}

static void attempt(double *best, const core *a, const core *b, double x, double y)
{
    const double length = hypot(x, y);
    if (length > 1e-12) {
        *best = fmax(*best, beyond(a, b, x / length, y / length));
        *best = fmax(*best, beyond(a, b, -x / length, -y / length));
    }
}

// [m] negative: overlap.
static double separation(const core *a, const core *b)
{
    double best = beyond(a, b, 1, 0);
    for (int side = 0; side < 2; ++side) {
        const core *p = side == 0 ? a : b;
        for (int i = 0; i < p->count; ++i) {
            const int k = (i + 1) % p->count;
            attempt(&best, a, b, p->y[k] - p->y[i], p->x[i] - p->x[k]);
        }
    }
    for (int i = 0; i < a->count; ++i) {
        for (int k = 0; k < b->count; ++k) {
            attempt(&best, a, b, b->x[k] - a->x[i], b->y[k] - a->y[i]);
        }
    }
    return best;
}

static plumb_transform random_place(double size)
{
    return plumb_transform_make(random_point(size), R(uniform(-4, 4)));
}

// [m] float: a few roundings of coordinates of up to 10 m.
#define NEAR_ENOUGH (64 * (double)PLUMB_REAL_EPSILON + 1e-10)

static void is_on_surface(const plumb_convex *s, plumb_transform t, plumb_vec2 point)
{
    const plumb_convex dot = { .count = 1, .points = { point } };
    const core a = place(s, t), b = place(&dot, plumb_transform_identity());
    assert_near(separation(&a, &b), 0, NEAR_ENOUGH);
}

static void distances_are_those_of_brute_force(void **state)
{
    (void)state;
    int apart = 0, deep = 0;
    for (int i = 0; i < 20000; ++i) {
        const plumb_convex a = random_shape(i), b = random_shape(i / 5);
        const plumb_transform at_a = random_place(1), at_b = random_place(i % 2 == 0 ? 6 : 2);
        const core ca = place(&a, at_a), cb = place(&b, at_b);
        const plumb_convex_gap gap = plumb_convex_distance(&a, at_a, &b, at_b);
        const double d = (double)gap.distance, exact = separation(&ca, &cb);
        assert_near(d, exact, NEAR_ENOUGH);
        assert_near(beyond(&ca, &cb, (double)gap.normal.x, (double)gap.normal.y), exact,
                    NEAR_ENOUGH);
        assert_near((double)plumb_vec2_magnitude(gap.normal), 1, ROUNDED(1e-6));
        const plumb_vec2 other = plumb_vec2_add_scaled(gap.point_a, gap.distance, gap.normal);
        assert_near((double)plumb_vec2_distance(other, gap.point_b), 0, NEAR_ENOUGH);
        if (d > 0) { // inside one another, points that far apart need not lie on either surface
            is_on_surface(&a, at_a, gap.point_a);
            is_on_surface(&b, at_b, gap.point_b);
        }
        // The other way round, and pushed apart by so much they just touch.
        const plumb_convex_gap back = plumb_convex_distance(&b, at_b, &a, at_a);
        assert_near(back.distance, exact, NEAR_ENOUGH);
        const plumb_transform parted = { plumb_vec2_add_scaled(at_b.p, -gap.distance, gap.normal),
                                         at_b.q };
        assert_near((double)plumb_convex_distance(&a, at_a, &b, parted).distance, 0, NEAR_ENOUGH);
        apart += d > 0;
        deep += d < -0.1;
    }
    assert_true(apart > 5000 && deep > 3000);
}

static void faces_meet_in_the_middle_of_what_they_share(void **state)
{
    (void)state;
    plumb_convex box, disc;
    SAYS(plumb_convex_box(plumb_v2(1, 1), plumb_v2(0, 0), 0, 0, &box), OK);
    SAYS(plumb_convex_circle(plumb_v2(0, 0), R(0.5), &disc), OK);
    const plumb_transform here = plumb_transform_identity();
    plumb_convex_gap gap =
        plumb_convex_distance(&box, here, &box, plumb_transform_make(plumb_v2(3, 1), 0));
    assert_near(gap.distance, 1, ROUNDED(1e-6));
    assert_near(gap.point_a.x, 1, ROUNDED(1e-6));
    assert_near(gap.point_a.y, 0.5, ROUNDED(1e-6));
    assert_near(gap.point_b.x, 2, ROUNDED(1e-6));
    assert_near(gap.normal.x, 1, ROUNDED(1e-6));
    gap = plumb_convex_distance(&box, here, &disc, plumb_transform_make(plumb_v2(0, R(1.2)), 0));
    assert_near(gap.distance, -0.3, ROUNDED(1e-6));
    assert_near(gap.point_a.y, 1, ROUNDED(1e-6));
    assert_near(gap.point_b.y, 0.7, ROUNDED(1e-6));
    gap = plumb_convex_distance(&disc, here, &disc, here); // one in the other: some normal
    assert_near(gap.distance, -1, ROUNDED(1e-6));
    assert_near((double)plumb_vec2_magnitude(gap.normal), 1, ROUNDED(1e-6));
}

static void casts_stop_where_shapes_touch(void **state)
{
    (void)state;
    int met = 0;
    for (int i = 0; i < 20000; ++i) {
        const plumb_convex a = random_shape(i), b = random_shape(i / 5);
        const plumb_transform at_a = random_place(1), at_b = random_place(6);
        const plumb_vec2 way = random_point(10);
        const core ca = place(&a, at_a), cb = place(&b, at_b);
        plumb_convex_hit hit = { .fraction = 7 };
        const bool meets = plumb_convex_cast(&a, at_a, &b, at_b, way, &hit);
        const double slack = 4 * NEAR_ENOUGH;
        if (separation(&ca, &cb) < -slack) {
            assert_true(meets && hit.fraction == 0);
            continue;
        }
        // Nothing overlaps before, and at the end they touch.
        for (int k = 0; k <= 20; ++k) {
            const plumb_real t = R(k) / 20 * (meets ? hit.fraction : 1);
            const plumb_transform then = { plumb_vec2_add_scaled(at_b.p, t, way), at_b.q };
            const core moved = place(&b, then);
            const double gap = separation(&ca, &moved);
            assert_true(gap > -slack);
            if (meets && k == 20) {
                assert_near(gap, 0, slack);
                assert_near(beyond(&ca, &moved, (double)hit.normal.x, (double)hit.normal.y), 0,
                            slack);
                is_on_surface(&a, at_a, hit.point);
            }
        }
        assert_true(meets || hit.fraction == 7);
        met += meets;
    }
    assert_true(met > 2000);
}

static void turning_shapes_stop_before_they_overlap(void **state)
{
    (void)state;
    int met = 0;
    for (int i = 0; i < 4000; ++i) {
        const plumb_convex a = random_shape(i), b = random_shape(i / 5);
        const plumb_convex_motion ma = { random_place(1), random_point(2), R(uniform(-9, 9)) };
        const plumb_convex_motion mb = { random_place(7), random_point(10), R(uniform(-9, 9)) };
        const plumb_convex_gap first = plumb_convex_distance(&a, ma.from, &b, mb.from);
        plumb_convex_hit hit = { .fraction = 7 };
        const bool meets = plumb_convex_impact(&a, ma, &b, mb, &hit);
        if (first.distance < R(9e-5)) {
            assert_true(meets && hit.fraction == 0);
            continue;
        }
        const double end = meets ? (double)hit.fraction : 1;
        for (int k = 0; k <= 64; ++k) {
            const plumb_real t = R(end * k / 64);
            const plumb_transform ta = { plumb_vec2_add_scaled(ma.from.p, t, ma.translation),
                                         plumb_rot_mul(ma.from.q, plumb_rot_make(t * ma.angle)) };
            const plumb_transform tb = { plumb_vec2_add_scaled(mb.from.p, t, mb.translation),
                                         plumb_rot_mul(mb.from.q, plumb_rot_make(t * mb.angle)) };
            const double gap = (double)plumb_convex_distance(&a, ta, &b, tb).distance;
            assert_true(gap > -2e-5);
            if (meets && k == 64) {
                assert_near(gap, 0, 1.2e-4);
                is_on_surface(&a, ta, hit.point);
            }
        }
        assert_true(meets || hit.fraction == 7);
        met += meets;
    }
    assert_true(met > 500);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup(distances_are_those_of_brute_force, seed),
        cmocka_unit_test_setup(faces_meet_in_the_middle_of_what_they_share, seed),
        cmocka_unit_test_setup(casts_stop_where_shapes_touch, seed),
        cmocka_unit_test_setup(turning_shapes_stop_before_they_overlap, seed),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
