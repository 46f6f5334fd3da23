// test_geometry.c - makers, hull, mass, boxes, nearest points and rays of convex shapes, against
// closed forms, brute force and fine grids.

#include "geometry_fixture.h"

#include <stdio.h>
#include <string.h>

static void makers_refuse_what_they_cannot_make(void **state)
{
    (void)state;
    plumb_vec2 o = { 0, 0 }, x = { 1, 0 }, far = { R(2e7), 0 }, bad = { nan_real(), 0 };
    plumb_convex s, before;
    memset(&s, 0x5a, sizeof s);
    before = s;
    SAYS(plumb_convex_circle(o, 1, NULL), E_NULL);
    SAYS(plumb_convex_circle(bad, 1, &s), E_NOT_FINITE);
    SAYS(plumb_convex_circle(o, nan_real(), &s), E_NOT_FINITE);
    SAYS(plumb_convex_circle(far, 1, &s), E_RANGE);
    SAYS(plumb_convex_circle(far, nan_real(), &s), E_NOT_FINITE);
    SAYS(plumb_convex_circle(o, 0, &s), E_RANGE);
    SAYS(plumb_convex_circle(o, -1, &s), E_RANGE);
    SAYS(plumb_convex_circle(o, R(2e7), &s), E_RANGE);
    SAYS(plumb_convex_capsule(o, x, 1, NULL), E_NULL);
    SAYS(plumb_convex_capsule(o, o, 1, &s), E_GEOMETRY);
    SAYS(plumb_convex_capsule(o, x, 0, &s), E_RANGE);
    SAYS(plumb_convex_capsule(o, bad, 1, &s), E_NOT_FINITE);
    SAYS(plumb_convex_segment(x, x, &s), E_GEOMETRY);
    SAYS(plumb_convex_segment(o, far, &s), E_RANGE);
    SAYS(plumb_convex_segment(o, x, NULL), E_NULL);
    SAYS(plumb_convex_box(plumb_v2(1, 0), o, 0, 0, &s), E_RANGE);
    SAYS(plumb_convex_box(plumb_v2(-1, 1), o, 0, 0, &s), E_RANGE);
    SAYS(plumb_convex_box(plumb_v2(1, 1), bad, 0, 0, &s), E_NOT_FINITE);
    SAYS(plumb_convex_box(plumb_v2(1, 1), o, nan_real(), 0, &s), E_NOT_FINITE);
    SAYS(plumb_convex_box(plumb_v2(1, 1), o, 0, -1, &s), E_RANGE);
    SAYS(plumb_convex_box(plumb_v2(1, 1), o, 0, 0, NULL), E_NULL);
    plumb_vec2 square[4] = { { 0, 0 }, { 1, 0 }, { 1, 1 }, { 0, 1 } };
    SAYS(plumb_convex_polygon(NULL, 4, 0, &s), E_NULL);
    SAYS(plumb_convex_polygon(square, 4, 0, NULL), E_NULL);
    SAYS(plumb_convex_polygon(square, 2, 0, &s), E_RANGE);
    SAYS(plumb_convex_polygon(square, 4, -1, &s), E_RANGE);
    SAYS(plumb_convex_polygon(square, 4, nan_real(), &s), E_NOT_FINITE);
    if (sizeof(plumb_real) == 4) { // corners coincide in rounding
        SAYS(plumb_convex_box(plumb_v2(R(0.01), R(0.01)), plumb_v2(R(9e6), 0), 0, 0, &s),
             E_GEOMETRY);
    }
    assert_memory_equal(&s, &before, sizeof s);
}

static void hulls_refuse_degenerate_clouds(void **state)
{
    (void)state;
    plumb_vec2 many[300], hull[PLUMB_POLYGON_MAX_VERTICES];
    int n = -7;
    plumb_vec2 line[5] = { { 0, 0 }, { 1, 1 }, { 2, 2 }, { R(0.3), R(0.3) }, { 1, 1 } };
    plumb_vec2 dot[4] = { { 1, 1 }, { 1, 1 }, { 1, 1 }, { R(1.000001), 1 } };
    plumb_vec2 thin[3] = { { 0, 0 }, { 1, 0 }, { R(0.5), R(1e-6) } };
    plumb_vec2 bad[3] = { { 0, 0 }, { 1, 0 }, { nan_real(), 0 } };
    plumb_vec2 far[3] = { { 0, 0 }, { 1, 0 }, { 0, R(1e8) } };
    for (int i = 0; i < COUNT(many); i++) {
        plumb_rot q = plumb_rot_make(R(2 * PI * i / COUNT(many)));
        many[i] = plumb_v2(q.c, q.s);
    }
    SAYS(plumb_hull(line, 5, hull, 16, &n), E_GEOMETRY);
    SAYS(plumb_hull(dot, 4, hull, 16, &n), E_GEOMETRY);
    SAYS(plumb_hull(thin, 3, hull, 16, &n), E_GEOMETRY);
    SAYS(plumb_hull(bad, 3, hull, 16, &n), E_NOT_FINITE);
    SAYS(plumb_hull(far, 3, hull, 16, &n), E_RANGE);
    SAYS(plumb_hull(many, 300, hull, 16, &n), E_CAPACITY);
    SAYS(plumb_hull(many, 200, hull, 16, &n), E_CAPACITY);
    SAYS(plumb_hull(many, 2, hull, 16, &n), E_RANGE);
    SAYS(plumb_hull(NULL, 3, hull, 16, &n), E_NULL);
    SAYS(plumb_hull(many, 3, NULL, 16, &n), E_NULL);
    SAYS(plumb_hull(many, 3, hull, 16, NULL), E_NULL);
    assert_int_equal(n, -7);
}

static void hulls_drop_duplicates_and_points_in_line(void **state)
{
    (void)state;
    // A unit square with edge midpoints, repeated corners, near-repeated corners, inner points.
    plumb_vec2 cloud[] = { { 1, 1 },         { 0, 0 }, { R(0.5), 0 },  { 1, 0 },
                           { 1, R(0.5) },    { 0, 1 }, { 0, R(0.5) },  { R(0.5), 1 },
                           { 1, 1 },         { 0, 0 }, { 1, R(1e-6) }, { R(0.3), R(0.4) },
                           { R(0.9), R(.9) } };
    plumb_vec2 hull[16];
    int n;
    SAYS(plumb_hull(cloud, COUNT(cloud), hull, 16, &n), OK);
    assert_int_equal(n, 4);
    assert_near(plumb_outline_area(hull, n), 1, ROUNDED(1e-5));
    assert_true(hull[0].x == 0 && hull[0].y == 0 && hull[1].x == 1 && hull[1].y == 0);
    // Next to a corner, and out of an edge by less than the coordinates' rounding.
    plumb_vec2 noisy[] = { { 0, 0 }, { R(0.5), R(-2 * EPS) },
                           { 1, 0 }, { R(1 + 1e-6), R(1e-6) },
                           { 1, 1 }, { 0, 1 } };
    SAYS(plumb_hull(noisy, COUNT(noisy), hull, 16, &n), OK);
    assert_int_equal(n, 4);
    // 16 are allowed.
    for (int i = 0; i < 16; i++) {
        plumb_rot q = plumb_rot_make(R(2 * PI * i / 16));
        hull[i] = plumb_v2(q.c, q.s);
    }
    plumb_convex shape;
    SAYS(plumb_convex_polygon(hull, 16, 0, &shape), OK);
    assert_int_equal(shape.count, 16);
}

static void hulls_of_random_clouds_hold_all_points(void **state)
{
    (void)state;
    for (int trial = 0; trial < 400; trial++) {
        plumb_vec2 cloud[120], hull[PLUMB_OUTLINE_MAX_VERTICES];
        int count = 3 + trial % 110, n = 0;
        double grid = trial % 3 == 0 ? 4 : 1e9; // coarse grids make points in line and repeats
        double size = pow(10, uniform(-2, 5));
        for (int i = 0; i < count; i++) {
            double x = uniform(-1, 1), y = uniform(-1, 1);
            cloud[i] = plumb_v2(R(size * round(x * grid) / grid), R(size * round(y * grid) / grid));
        }
        if (plumb_hull(cloud, count, hull, COUNT(hull), &n) != PLUMB_OK) {
            assert_true(count < 8); // few points of a coarse grid may be in line
            continue;
        }
        assert_true(plumb_outline_is_convex(hull, n) && plumb_outline_area(hull, n) > 0);
        double slack = 1e-5 + 16 * EPS * size;
        for (int i = 0; i < n; i++) {
            plumb_vec2 a = hull[i], b = hull[(i + 1) % n], c = hull[(i + 2) % n];
            assert_true(plumb_vec2_cross(plumb_vec2_sub(b, a), plumb_vec2_sub(c, b)) > 0);
            plumb_vec2 outward = plumb_vec2_unit(plumb_vec2_right(plumb_vec2_sub(b, a)));
            bool is_given = false;
            for (int k = 0; k < count; k++) {
                double out = (double)plumb_vec2_dot(outward, plumb_vec2_sub(cloud[k], a));
                assert_true(out <= slack);
                is_given = is_given || memcmp(&cloud[k], &a, sizeof a) == 0;
            }
            assert_true(is_given);
        }
    }
}

static void makers_give_outward_unit_normals(void **state)
{
    (void)state;
    for (int trial = 0; trial < 500; trial++) {
        plumb_convex s = random_shape(trial);
        for (int i = 0; s.count > 1 && i < s.count; i++) {
            plumb_vec2 edge = plumb_vec2_sub(s.points[(i + 1) % s.count], s.points[i]);
            assert_near(plumb_vec2_magnitude(s.normals[i]), 1, 4 * EPS);
            assert_near(plumb_vec2_dot(s.normals[i], plumb_vec2_unit(edge)), 0, 1e3 * EPS);
            assert_true(plumb_vec2_cross(s.normals[i], edge) > 0); // outward is to the right
        }
        for (int i = s.count; i < PLUMB_POLYGON_MAX_VERTICES; i++) {
            assert_true(s.points[i].x == 0 && s.points[i].y == 0);
        }
    }
    plumb_convex box;
    SAYS(plumb_convex_box(plumb_v2(2, 1), plumb_v2(5, 6), R(PI / 2), R(0.1), &box), OK);
    assert_int_equal(box.count, 4);
    assert_near(box.points[0].x, 6, 1e-6); // the corner (-2, -1), turned left
    assert_near(box.points[0].y, 4, ROUNDED(1e-6));
    assert_near(box.normals[0].x, 1, ROUNDED(1e-6));
    assert_near(box.radius, 0.1, ROUNDED(1e-6));
}

static void outlines_are_checked(void **state)
{
    (void)state;
    plumb_vec2 square[] = { { 0, 0 }, { 1, 0 }, { 1, 1 }, { 0, 1 } };
    plumb_vec2 clockwise[] = { { 0, 0 }, { 0, 1 }, { 1, 1 }, { 1, 0 } };
    plumb_vec2 dart[] = { { 0, 0 }, { 2, 1 }, { 0, 2 }, { R(0.5), 1 } };
    plumb_vec2 bow_tie[] = { { 0, 0 }, { 1, 1 }, { 1, 0 }, { 0, 1 } };
    plumb_vec2 spike[] = { { 0, 0 }, { 1, 0 }, { 2, 0 }, { 1, 0 }, { 1, 1 } };
    plumb_vec2 touch[] = { { 0, 0 }, { 2, 0 }, { 2, 2 }, { 1, 0 }, { 0, 2 } };
    plumb_vec2 line[] = { { 0, 0 }, { 1, 0 }, { 3, 0 } };
    plumb_vec2 bad[] = { { 0, 0 }, { 1, 0 }, { 1, nan_real() } };
    plumb_vec2 star[5], closed[] = { { 0, 0 }, { 0, 0 }, { 1, 0 }, { 2, 0 }, { 2, 0 },
                                     { 2, 2 }, { 0, 2 }, { 0, 1 }, { 0, 0 } };
    for (int i = 0; i < 5; i++) { // a pentagram turns to one side only, but twice around
        plumb_rot q = plumb_rot_make(R(4 * PI * i / 5));
        star[i] = plumb_v2(q.c, q.s);
    }
    SAYS(plumb_outline_check(square, 4), OK);
    SAYS(plumb_outline_check(clockwise, 4), OK);
    SAYS(plumb_outline_check(dart, 4), OK);
    SAYS(plumb_outline_check(closed, COUNT(closed)), OK);
    SAYS(plumb_outline_check(bow_tie, 4), E_GEOMETRY);
    SAYS(plumb_outline_check(spike, 5), E_GEOMETRY);
    SAYS(plumb_outline_check(touch, 5), E_GEOMETRY);
    SAYS(plumb_outline_check(star, 5), E_GEOMETRY);
    SAYS(plumb_outline_check(line, 3), E_GEOMETRY);
    SAYS(plumb_outline_check(square, 2), E_RANGE);
    SAYS(plumb_outline_check(NULL, 4), E_NULL);
    SAYS(plumb_outline_check(bad, 3), E_NOT_FINITE);
    SAYS(plumb_outline_check(square, 257), E_CAPACITY);
    assert_true(plumb_outline_is_convex(square, 4) && plumb_outline_is_convex(clockwise, 4));
    assert_true(plumb_outline_is_convex(closed, COUNT(closed)));
    assert_false(plumb_outline_is_convex(dart, 4) || plumb_outline_is_convex(bow_tie, 4));
    assert_false(plumb_outline_is_convex(star, 5) || plumb_outline_is_convex(line, 3));
    assert_false(plumb_outline_is_convex(spike, 5) || plumb_outline_is_convex(square, 2));
    assert_near(plumb_outline_area(square, 4), 1, 0);
    assert_near(plumb_outline_area(clockwise, 4), -1, 0);
    assert_near(plumb_outline_area(dart, 4), 1.5, 0);
    assert_near(plumb_outline_area(line, 3), 0, 0);
    assert_true(plumb_outline_contains(dart, 4, plumb_v2(1, 1)));
    assert_false(plumb_outline_contains(dart, 4, plumb_v2(R(0.2), 1)));
}

// Points so near a slanted line that a plain cross product cannot tell their side (after Kettner
// et al., "Classroom examples of robustness problems in geometric computations", 2008).
static void sides_of_a_line_are_told_exactly(void **state)
{
    (void)state;
    plumb_vec2 above[3] = { { -12, -12 }, { 24, 24 }, { -12, 24 } };
    double tick = EPS / 2;
    for (int i = 0; i < 32; i++) {
        for (int k = 0; k < 32; k++) {
            plumb_vec2 p = plumb_v2(R(0.5 + i * tick), R(0.5 + k * tick));
            if (i != k) {
                assert_int_equal(plumb_outline_contains(above, 3, p), k > i);
            }
        }
    }
}

static void boxes_and_supports_touch_the_shape(void **state)
{
    (void)state;
    for (int trial = 0; trial < 500; trial++) {
        plumb_convex s = random_shape(trial), moved;
        plumb_transform t = plumb_transform_make(random_point(5), R(uniform(-3, 3)));
        plumb_convex_transform(&s, t, &moved);
        plumb_aabb box = plumb_convex_aabb(&s, t);
        assert_near(plumb_convex_support(&moved, plumb_v2(1, 0)).x, box.max.x, 40 * EPS);
        assert_near(plumb_convex_support(&moved, plumb_v2(-3, 0)).x, box.min.x, 40 * EPS);
        assert_near(plumb_convex_support(&moved, plumb_v2(0, 2)).y, box.max.y, 40 * EPS);
        assert_near(plumb_convex_support(&moved, plumb_v2(0, -1)).y, box.min.y, 40 * EPS);
        plumb_vec2 d = random_point(1);
        plumb_vec2 far = plumb_convex_support(&s, d);
        int index = plumb_convex_support_index(&s, d);
        assert_near(plumb_convex_nearest(&s, far).distance, 0, 100 * EPS);
        for (int i = 0; i < s.count; i++) {
            assert_true(plumb_vec2_dot(s.points[i], d) <= plumb_vec2_dot(s.points[index], d));
        }
    }
}

// Distance to the core by trying many points of its boundary; negative inside.
static double brute_distance(const plumb_convex *s, plumb_vec2 p)
{
    double best = 1e30;
    bool inside = s->count >= 3;
    for (int i = 0; i < s->count; i++) {
        plumb_vec2 a = s->points[i], b = s->points[(i + 1) % s->count];
        for (int k = 0; k <= 2000; k++) {
            double d = (double)plumb_vec2_distance(p, plumb_vec2_lerp(a, b, R(k / 2000.0)));
            best = d < best ? d : best;
        }
        inside = inside && plumb_vec2_cross(plumb_vec2_sub(b, a), plumb_vec2_sub(p, a)) >= 0;
    }
    return (inside ? -best : best) - (double)s->radius;
}

static void nearest_points_match_brute_force(void **state)
{
    (void)state;
    for (int trial = 0; trial < 400; trial++) {
        plumb_convex s = random_shape(trial);
        plumb_vec2 p = random_point(3);
        plumb_convex_near near = plumb_convex_nearest(&s, p);
        assert_near(near.distance, brute_distance(&s, p), 2e-4);
        assert_near(plumb_vec2_magnitude(near.normal), 1, 8 * EPS);
        plumb_vec2 again = plumb_vec2_add_scaled(near.point, near.distance, near.normal);
        assert_near(again.x, p.x, 40 * EPS);
        assert_near(again.y, p.y, 40 * EPS);
        assert_near(plumb_convex_nearest(&s, near.point).distance, 0, 40 * EPS);
        assert_int_equal(plumb_convex_contains(&s, p), near.distance <= 0);
    }
    plumb_convex c, seg;
    SAYS(plumb_convex_circle(plumb_v2(1, 2), 3, &c), OK);
    plumb_convex_near near = plumb_convex_nearest(&c, plumb_v2(1, 2));
    assert_near(near.distance, -3, 0);
    assert_near(near.normal.x, 1, 0);
    assert_near(near.point.x, 4, 0);
    SAYS(plumb_convex_segment(plumb_v2(0, 0), plumb_v2(2, 0), &seg), OK);
    near = plumb_convex_nearest(&seg, plumb_v2(1, 0)); // on it
    assert_near(near.distance, 0, 0);
    assert_near(plumb_abs(near.normal.y), 1, 0);
    near = plumb_convex_nearest(&seg, plumb_v2(5, 0)); // in line with it
    assert_near(near.distance, 3, 0);
    assert_near(near.normal.x, 1, 0);
    near = plumb_convex_nearest(&seg, plumb_v2(2, 0)); // its very end
    assert_near(near.distance, 0, 0);
    assert_near(plumb_vec2_magnitude(near.normal), 1, 0);
}

static void rays_stop_at_the_surface(void **state)
{
    (void)state;
    int hits = 0;
    for (int trial = 0; trial < 4000; trial++) {
        plumb_convex s = random_shape(trial);
        plumb_vec2 o = random_point(6), d = random_point(12);
        plumb_convex_hit hit;
        bool met = plumb_convex_ray(&s, o, d, &hit);
        double limit = met ? (double)hit.fraction : 1;
        // No place before the hit may lie deeper inside than rounding.
        for (int k = 0; k < 200; k++) {
            plumb_vec2 p = plumb_vec2_add_scaled(o, R(limit * k / 200.0), d);
            double depth = -(double)plumb_convex_nearest(&s, p).distance;
            assert_true(depth <= 100 * EPS || (met && hit.fraction == 0));
        }
        if (!met) {
            continue;
        }
        hits++;
        assert_true(hit.fraction >= 0 && hit.fraction <= 1);
        if (plumb_convex_contains(&s, o)) {
            assert_true(hit.fraction == 0 && hit.normal.x == 0 && hit.normal.y == 0);
            continue;
        }
        plumb_convex_near near = plumb_convex_nearest(&s, hit.point);
        assert_near(near.distance, 0, 300 * EPS);
        assert_near(plumb_vec2_magnitude(hit.normal), 1, 20 * EPS);
        assert_true(plumb_vec2_dot(hit.normal, d) <= 0);
    }
    print_message("%d rays of 4000 hit\n", hits);
    assert_true(hits > 400);
}

static void rays_meet_known_places(void **state)
{
    (void)state;
    plumb_convex c, seg, box, round_box;
    plumb_convex_hit hit = { -1, { 0, 0 }, { 0, 0 } };
    SAYS(plumb_convex_circle(plumb_v2(0, 0), 1, &c), OK);
    SAYS(plumb_convex_segment(plumb_v2(0, -1), plumb_v2(0, 1), &seg), OK);
    SAYS(plumb_convex_box(plumb_v2(1, 1), plumb_v2(0, 0), 0, 0, &box), OK);
    SAYS(plumb_convex_box(plumb_v2(1, 1), plumb_v2(0, 0), 0, R(0.5), &round_box), OK);
    assert_true(plumb_convex_ray(&c, plumb_v2(-3, 0), plumb_v2(4, 0), &hit));
    assert_near(hit.fraction, 0.5, EPS);
    assert_near(hit.normal.x, -1, EPS);
    hit.fraction = -1;
    assert_false(plumb_convex_ray(&c, plumb_v2(-3, 0), plumb_v2(R(1.9), 0), &hit)); // too short
    assert_false(plumb_convex_ray(&c, plumb_v2(-3, 0), plumb_v2(-4, 0), &hit));     // away
    assert_false(plumb_convex_ray(&c, plumb_v2(-3, 2), plumb_v2(9, 0), &hit));      // beside
    assert_false(plumb_convex_ray(&c, plumb_v2(-3, 0), plumb_v2(0, 0), &hit));      // none
    assert_true(hit.fraction == -1);
    // From far away, where a quadratic formula would have lost all digits: 1e5 squared * eps > 1.
    assert_true(plumb_convex_ray(&c, plumb_v2(R(-1e5), R(0.5)), plumb_v2(R(2e5), 0), &hit));
    assert_near(hit.normal.y, 0.5, ROUNDED(1e-5));
    // A segment from both sides and along it.
    assert_true(plumb_convex_ray(&seg, plumb_v2(-1, 0), plumb_v2(2, 0), &hit));
    assert_near(hit.normal.x, -1, 0);
    assert_true(plumb_convex_ray(&seg, plumb_v2(1, 0), plumb_v2(-2, 0), &hit));
    assert_near(hit.normal.x, 1, 0);
    assert_near(hit.fraction, 0.5, 0);
    assert_true(plumb_convex_ray(&seg, plumb_v2(0, 5), plumb_v2(0, -8), &hit));
    assert_near(hit.fraction, 0.5, EPS);
    assert_near(hit.normal.y, 1, 0);
    assert_false(plumb_convex_ray(&seg, plumb_v2(R(0.1), 5), plumb_v2(0, -8), &hit));
    // A corner head on, and a ray along an edge's line.
    assert_true(plumb_convex_ray(&box, plumb_v2(-2, -2), plumb_v2(4, 4), &hit));
    assert_near(hit.fraction, 0.25, EPS);
    assert_true(plumb_convex_ray(&box, plumb_v2(-3, 1), plumb_v2(4, 0), &hit));
    assert_near(hit.fraction, 0.5, EPS);
    assert_true(plumb_convex_ray(&round_box, plumb_v2(-3, -3), plumb_v2(4, 4), &hit));
    assert_near(hit.fraction, (2 - 0.5 / sqrt(2)) / 4, 4 * EPS);
    assert_near(hit.normal.x, -sqrt(0.5), 8 * EPS);
}

// Rounding may let a ray along a line miss it, or find either end: what it meets is the nearer one.
static void rays_along_lines_meet_the_nearer_end(void **state)
{
    (void)state;
    int met = 0;
    for (int i = 0; i < 20000; ++i) {
        plumb_convex line;
        plumb_convex_hit hit;
        const plumb_vec2 a = random_point(9), b = random_point(9);
        if (plumb_convex_segment(a, b, &line) != PLUMB_OK) {
            continue;
        }
        const plumb_real beyond = R(uniform(1.5, 4)), short_of = R(uniform(0, 0.5));
        const plumb_vec2 from = plumb_vec2_lerp(a, b, beyond);
        const plumb_vec2 to = plumb_vec2_lerp(a, b, i % 2 ? short_of : 0);
        if (plumb_convex_ray(&line, from, plumb_vec2_sub(to, from), &hit)) {
            assert_near(plumb_vec2_distance(hit.point, b), 0, ROUNDED(1e-4));
            ++met;
        }
    }
    assert_true(met > 1000);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup(makers_refuse_what_they_cannot_make, seed),
        cmocka_unit_test_setup(hulls_refuse_degenerate_clouds, seed),
        cmocka_unit_test_setup(hulls_drop_duplicates_and_points_in_line, seed),
        cmocka_unit_test_setup(hulls_of_random_clouds_hold_all_points, seed),
        cmocka_unit_test_setup(makers_give_outward_unit_normals, seed),
        cmocka_unit_test_setup(outlines_are_checked, seed),
        cmocka_unit_test_setup(sides_of_a_line_are_told_exactly, seed),
        cmocka_unit_test_setup(boxes_and_supports_touch_the_shape, seed),
        cmocka_unit_test_setup(nearest_points_match_brute_force, seed),
        cmocka_unit_test_setup(rays_stop_at_the_surface, seed),
        cmocka_unit_test_setup(rays_meet_known_places, seed),
        cmocka_unit_test_setup(rays_along_lines_meet_the_nearer_end, seed),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
