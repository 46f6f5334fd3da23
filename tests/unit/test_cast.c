// test_cast.c - shape casts: the sum of two shapes against sampling with the overlap test, worlds
// against brute force over all shapes, degenerate ways, batches against single calls.

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "harness/near.h"
#include "harness/random.h"
#include "plumb/plumb.h"
#include "query/sweep.h"

#define R(x)      ((plumb_real)(x))
#define V(x, y)   plumb_v2(R(x), R(y))
#define MOST      400
#define IS_DOUBLE (sizeof(plumb_real) == sizeof(double))

static uint32_t random_state;

static double uniform(double low, double high)
{
    return sim_uniform(&random_state, low, high);
}

static plumb_transform random_place(double reach)
{
    plumb_vec2 p = V(uniform(-reach, reach), uniform(-reach, reach));
    return plumb_transform_make(p, R(uniform(-4, 4)));
}

// A point, line, box, triangle or many-cornered hull, rounded or not.
static plumb_convex random_convex(double size)
{
    plumb_convex c;
    plumb_result r = PLUMB_OK;
    plumb_vec2 p[12];
    for (int i = 0; i < 12; ++i) {
        p[i] = V(uniform(-size, size), uniform(-size, size));
    }
    plumb_real radius = uniform(0, 1) < 0.5 ? 0 : R(uniform(0.05, 0.4) * size);
    switch ((int)uniform(0, 4.999)) {
    case 0:
        r = plumb_convex_circle(p[0], R(uniform(0.1, 1) * size), &c);
        break;
    case 1:
        r = radius > 0 ? plumb_convex_capsule(p[0], p[1], radius, &c)
                       : plumb_convex_segment(p[0], p[1], &c);
        break;
    case 2:
        r = plumb_convex_box(V(uniform(0.1, 1) * size, uniform(0.1, 1) * size), p[0],
                             R(uniform(0, 1) < 0.5 ? 0 : uniform(-3, 3)), radius, &c);
        break;
    default:
        r = plumb_convex_polygon(p, uniform(0, 1) < 0.5 ? 3 : 12, radius, &c);
        break;
    }
    return r == PLUMB_OK ? c : random_convex(size);
}

//---- the sum -------------------------------------------------------------------------------------

static bool overlap_at(const pl_round *fixed, const pl_round *mover, double dx, double dy)
{
    pl_round moved = *mover;
    for (int i = 0; i < moved.count; ++i) {
        moved.x[i] += dx;
        moved.y[i] += dy;
    }
    return pl_rounds_overlap(fixed, &moved);
}

static double shrink(double d, double by)
{
    return d > by ? d - by : 0;
}

// Overlap by more than `margin`: what must not happen before a hit.
static bool deep_at(const pl_round *fixed, const pl_round *mover, double dx, double dy,
                    double margin)
{
    pl_round less = *fixed;
    less.radius -= margin;
    return less.radius + mover->radius >= 0 && overlap_at(&less, mover, dx, dy);
}

static void check_depth(const pl_round *fixed, const pl_round *mover, const pl_sum_hit *hit)
{
    double out = hit->depth * (1 + 1e-9) + 1e-9, in = shrink(hit->depth, 1e-6);
    assert_false(overlap_at(fixed, mover, hit->nx * out, hit->ny * out));
    assert_true(overlap_at(fixed, mover, hit->nx * in, hit->ny * in));
    for (int k = 0; k < 32; ++k) { // no shorter way out
        double a = k * 0.19634954;
        assert_true(overlap_at(fixed, mover, cos(a) * in, sin(a) * in));
    }
}

static void check_touch(const pl_round *fixed, const pl_round *mover, const pl_sum_hit *hit,
                        double dx, double dy)
{
    double x, y;
    pl_round_touch(fixed, mover, dx, dy, hit->nx, hit->ny, &x, &y);
    pl_round spot = { .count = 1 };
    spot.x[0] = x, spot.y[0] = y;
    pl_round wide = *fixed;
    wide.radius += 2e-4; // faces a little out of parallel share no point exactly
    assert_true(pl_rounds_overlap(&wide, &spot));
    wide = *mover;
    for (int i = 0; i < wide.count; ++i) {
        wide.x[i] += dx, wide.y[i] += dy;
    }
    wide.radius += 2e-4;
    assert_true(pl_rounds_overlap(&wide, &spot));
}

static void test_sum_against_sampling(void **state)
{
    (void)state;
    random_state = 4711;
    int hits = 0, inside = 0, misses = 0;
    for (int i = 0; i < 40000; ++i) {
        plumb_convex a = random_convex(1), b = random_convex(1);
        pl_round fixed, mover;
        pl_round_make(&a, random_place(1), V(0, 0), &fixed);
        pl_round_make(&b, random_place(4), V(0, 0), &mover);
        double dx = uniform(-6, 6), dy = uniform(-6, 6), length = hypot(dx, dy);
        pl_sum sum;
        pl_sum_hit hit;
        pl_sum_make(&fixed, &mover, &sum);
        assert_in_range(sum.count, 1, fixed.count + mover.count);
        if (!pl_sum_cast(&sum, 0, 0, dx, dy, 1e-9, &hit)) {
            for (int k = 0; k <= 100; ++k) {
                assert_false(deep_at(&fixed, &mover, dx * k / 100, dy * k / 100, 1e-9));
            }
            ++misses;
            continue;
        }
        assert_near(hypot(hit.nx, hit.ny), 1, 1e-12);
        assert_true(overlap_at(&fixed, &mover, 0, 0) == (hit.depth > 0));
        if (hit.depth > 0) {
            assert_true(hit.fraction == 0);
            check_depth(&fixed, &mover, &hit);
            ++inside;
            continue;
        }
        double t = hit.fraction, approach = -(hit.nx * dx + hit.ny * dy) / length;
        assert_true(approach > 0 && t >= 0 && t <= 1);
        for (int k = 0; k < 100; ++k) {
            double s = t * k / 100;
            assert_false(overlap_at(&fixed, &mover, dx * s, dy * s));
        }
        double before = t - 1e-9 / length, after = t + 1e-8 / (length * approach);
        assert_false(overlap_at(&fixed, &mover, dx * before, dy * before));
        pl_round wide = fixed;
        wide.radius += 1e-9;
        assert_true(overlap_at(&wide, &mover, dx * t, dy * t));
        if (approach > 1e-3 && (sum.count > 2 || sum.radius > 0)) {
            pl_round thick = fixed;
            thick.radius += 1e-12;
            assert_true(overlap_at(&thick, &mover, dx * after, dy * after));
        }
        check_touch(&fixed, &mover, &hit, dx * t, dy * t);
        ++hits;
    }
    print_message("%d hits, %d inside, %d misses\n", hits, inside, misses);
    assert_true(hits > 3000 && inside > 1000 && misses > 5000);
}

static pl_round box_at(double x, double y, double hx, double hy)
{
    return (pl_round){ .x = { x - hx, x + hx, x + hx, x - hx },
                       .y = { y - hy, y - hy, y + hy, y + hy },
                       .count = 4 };
}

// Boxes that touch exactly: sliding along is free, into is a hit at once, away is none.
static void test_touching(void **state)
{
    (void)state;
    pl_round fixed = box_at(0, 0, 1, 1), mover = box_at(2, 0, 1, 1);
    pl_sum sum;
    pl_sum_hit hit;
    pl_sum_make(&fixed, &mover, &sum);
    assert_int_equal(sum.count, 4); // parallel edges are one
    assert_false(pl_sum_cast(&sum, 0, 0, 3, 0, 1e-9, &hit));
    assert_false(pl_sum_cast(&sum, 0, 0, 0, 3, 1e-9, &hit));
    assert_true(pl_sum_cast(&sum, 0, 0, -3, 1, 1e-9, &hit));
    assert_true(hit.fraction == 0 && hit.depth == 0 && hit.nx == 1 && hit.ny == 0);
    double x, y;
    pl_round_touch(&fixed, &mover, 0, 0, hit.nx, hit.ny, &x, &y);
    assert_true(x == 1 && y == 0);
    pl_round_touch(&fixed, &mover, 0, 1, hit.nx, hit.ny, &x, &y);
    assert_true(x == 1 && y == 0.5); // middle of what they share
    // A row of tiles: a box on the first slides over the second, above, touching or a rounding deep.
    pl_round next = box_at(2, 0, 1, 1);
    for (int i = -1; i <= 1; ++i) {
        pl_round on_top = box_at(0, 1.5 + i * 1e-10, 0.5, 0.5);
        pl_sum_make(&next, &on_top, &sum);
        assert_int_equal(pl_sum_cast(&sum, 0, 0, 3, 0, 1e-9, &hit), i < 0);
        pl_round ball = { .x = { 0 }, .y = { 1.5 + i * 1e-10 }, .count = 1, .radius = 0.5 };
        pl_sum_make(&next, &ball, &sum);
        if (pl_sum_cast(&sum, 0, 0, 3, 0, 1e-9, &hit)) {
            assert_true(i < 0 && hit.ny > 0.999); // no wall, at most a bump of a rounding
        }
    }
}

static void test_no_way(void **state)
{
    (void)state;
    pl_round fixed = box_at(0, 0, 1, 1), mover = box_at(1.5, 0, 1, 1), away = box_at(5, 0, 1, 1);
    pl_sum sum;
    pl_sum_hit hit;
    pl_sum_make(&fixed, &mover, &sum);
    assert_true(pl_sum_cast(&sum, 0, 0, 0, 0, 1e-9, &hit));
    assert_true(hit.depth == 0.5 && hit.nx == 1);
    pl_sum_make(&fixed, &away, &sum);
    assert_false(pl_sum_cast(&sum, 0, 0, 0, 0, 1e-9, &hit));
    assert_true(pl_sum_cast(&sum, 0, 0, -1e12, 0, 1e-9, &hit));
    assert_near(hit.fraction * 1e12, 3, ROUNDED(1e-3));
}

// Points, lines and coincident cores have sums without area.
static void test_thin_sums(void **state)
{
    (void)state;
    pl_round point = { .x = { 1 }, .y = { 2 }, .count = 1, .radius = 0.5 };
    pl_round line = { .x = { 0, 2 }, .y = { 0, 0 }, .count = 2 };
    pl_sum sum;
    pl_sum_hit hit;
    pl_sum_make(&point, &point, &sum);
    assert_true(sum.count == 1 && sum.x[0] == 0 && sum.radius == 1);
    assert_true(pl_sum_cast(&sum, 0, 0, 1, 0, 0, &hit));
    assert_true(hit.depth == 1 && hypot(hit.nx, hit.ny) == 1);
    pl_sum_make(&line, &line, &sum);
    assert_true(sum.count == 2 && sum.x[0] == -2 && sum.x[1] == 2);
    assert_false(pl_sum_cast(&sum, 0, 1, 1, 0, 0, &hit));
    assert_true(pl_sum_cast(&sum, 0, 1, 0, -2, 0, &hit));
    assert_true(hit.fraction == 0.5 && hit.ny == 1);
    pl_sum_make(&line, &point, &sum);
    assert_true(pl_sum_cast(&sum, 0, 0, 0, -4, 0, &hit));
    assert_true(hit.ny == 1 && fabs(hit.fraction * 4 - 1.5) < 1e-12);
}

//---- worlds --------------------------------------------------------------------------------------

static plumb_world *random_world(uint32_t seed, int count, double reach, plumb_vec2 center)
{
    plumb_world *world = NULL;
    random_state = seed * 2654435761u + 1;
    assert_int_equal(plumb_world_create(&(plumb_world_desc){ .zero_gravity = true }, &world),
                     PLUMB_OK);
    const plumb_vec2 ell[] = { { 0, 0 }, { 2, 0 }, { 2, 1 }, { 1, 1 }, { 1, 2 }, { 0, 2 } };
    for (int i = 0; i < count; ++i) {
        plumb_transform t = random_place(reach);
        plumb_body_desc desc = { .type = (plumb_body_type)(i % 3),
                                 .position = plumb_vec2_add(t.p, center),
                                 .angle = R(uniform(-3, 3)) };
        plumb_body body = plumb_body_create(world, &desc);
        plumb_shape_desc shape = { .kind = PLUMB_BOX, .half = V(uniform(0.1, 1), uniform(0.1, 1)) };
        if (i % 5 == 1) {
            shape = (plumb_shape_desc){ .kind = PLUMB_CIRCLE, .radius = R(uniform(0.1, 1)) };
        } else if (i % 5 == 2) {
            shape = (plumb_shape_desc){ .kind = PLUMB_OUTLINE, .points = ell, .count = 6 };
        } else if (i % 5 == 3) {
            shape = (plumb_shape_desc){ .kind = PLUMB_CAPSULE, .points = ell, .count = 2 };
            shape.radius = R(0.2);
        } else if (i % 5 == 4) {
            shape = (plumb_shape_desc){ .kind = PLUMB_CHAIN, .points = ell, .count = 5 };
        }
        assert_false(plumb_is_null(plumb_shape_create(world, body, &shape)));
    }
    return world;
}

// Every shape, piece by piece, without grid.
static int brute(plumb_world *world, const plumb_cast *cast, double touch, plumb_cast_hit *hits)
{
    plumb_shape shapes[MOST];
    int shape_count = plumb_world_shapes(world, shapes, MOST), count = 0;
    pl_round mover;
    pl_round_make(cast->convex, cast->transform, cast->transform.p, &mover);
    for (int i = 0; i < shape_count; ++i) {
        plumb_body body = plumb_shape_body(world, shapes[i]);
        plumb_cast_hit best = { .fraction = 2 };
        for (int k = 0; k < plumb_shape_piece_count(world, shapes[i]); ++k) {
            plumb_convex piece;
            pl_round fixed;
            pl_sum sum;
            pl_sum_hit hit;
            plumb_shape_piece(world, shapes[i], k, &piece, NULL);
            pl_round_make(&piece, plumb_body_transform(world, body), cast->transform.p, &fixed);
            pl_sum_make(&fixed, &mover, &sum);
            if (pl_sum_cast(&sum, 0, 0, (double)cast->translation.x, (double)cast->translation.y,
                            touch, &hit) &&
                (R(hit.fraction) < best.fraction ||
                 (R(hit.fraction) == best.fraction && R(hit.depth) > best.depth))) {
                best = (plumb_cast_hit){ .shape = shapes[i],
                                         .body = body,
                                         .fraction = R(hit.fraction),
                                         .depth = R(hit.depth) };
            }
        }
        if (best.fraction <= 1) {
            hits[count++] = best;
        }
    }
    return count;
}

static const plumb_cast_hit *find_hit(const plumb_cast_hit *hits, int count, plumb_shape shape)
{
    for (int i = 0; i < count; ++i) {
        if (plumb_same(hits[i].shape, shape)) {
            return &hits[i];
        }
    }
    return NULL;
}

static int check_cast(plumb_world *world, const plumb_cast *cast, double tolerance)
{
    static plumb_cast_hit expected[MOST], hits[MOST];
    int expected_count = brute(world, cast, 1e-5, expected);
    int count = plumb_world_cast_all(world, cast, NULL, hits, MOST);
    double length = (double)plumb_vec2_magnitude(cast->translation) + 1e-6;
    for (int i = 0; i < count; ++i) {
        const plumb_cast_hit *e = find_hit(expected, expected_count, hits[i].shape);
        assert_non_null(e);
        assert_true(fabs((double)(e->fraction - hits[i].fraction)) * length <= tolerance);
        assert_near((double)(e->depth - hits[i].depth), 0, tolerance);
        assert_true(plumb_same(e->body, hits[i].body));
        assert_true(i == 0 || hits[i - 1].fraction <= hits[i].fraction);
    }
    assert_int_equal(count, expected_count);
    plumb_cast_hit first;
    memset(&first, 77, sizeof first);
    bool met = plumb_world_cast(world, cast, NULL, &first);
    assert_int_equal(met, count > 0);
    assert_int_equal(plumb_world_cast_any(world, cast, NULL), met);
    if (met) {
        assert_true(first.fraction == hits[0].fraction);
        const plumb_cast_hit *same = find_hit(hits, count, first.shape);
        assert_non_null(same);
        assert_true(first.depth >= hits[0].depth);
        assert_near((double)plumb_vec2_magnitude(first.normal), 1, ROUNDED(1e-6));
        double reach = fabs((double)cast->transform.p.x) + fabs((double)cast->transform.p.y) + 10;
        plumb_nearest_hit near; // the point lies on what was hit
        assert_true(plumb_world_nearest(world, first.point, 1, NULL, &near));
        assert_true((double)near.distance <= 1e-5 * reach);
    }
    return count;
}

static void test_worlds(void **state)
{
    (void)state;
    int met = 0;
    for (uint32_t seed = 1; seed <= 40; ++seed) {
        plumb_world *world = random_world(seed, 60, seed % 2 ? 8 : 40, V(0, 0));
        for (int i = 0; i < 60; ++i) {
            plumb_convex shape = random_convex(i % 3 == 0 ? 3 : 0.5);
            plumb_cast cast = { &shape, random_place(20), V(uniform(-30, 30), uniform(-30, 30)) };
            cast.translation = i % 7 == 0 ? V(0, 0) : cast.translation;
            cast.translation = i % 7 == 1 ? V(1e6, 3e5) : cast.translation;
            met += check_cast(world, &cast, i % 7 == 1 ? 0.2 : 2e-5) > 0;
        }
        plumb_world_destroy(world);
    }
    assert_true(met > 800);
}

// 30 km out the answer is as good as the places of the bodies: a few roundings of 2 mm in float.
static void test_far_from_origin(void **state)
{
    (void)state;
    for (uint32_t seed = 1; seed <= 10; ++seed) {
        plumb_vec2 center = V(20000, -22000);
        const double touch = 4 * (double)PLUMB_REAL_EPSILON * 42020;
        plumb_world *world = random_world(seed, 30, 8, center);
        for (int i = 0; i < 40; ++i) {
            plumb_convex shape = random_convex(0.5);
            plumb_cast cast = { &shape, random_place(12), V(uniform(-20, 20), uniform(-20, 20)) };
            cast.transform.p = plumb_vec2_add(cast.transform.p, center);
            static plumb_cast_hit expected[MOST];
            plumb_cast_hit hit;
            int count = brute(world, &cast, touch, expected);
            bool met = plumb_world_cast(world, &cast, NULL, &hit);
            double first = 2;
            for (int k = 0; k < count; ++k) {
                first = fmin(first, (double)expected[k].fraction);
            }
            if (met && hit.depth == 0) {
                double error = fabs(first - (double)hit.fraction) *
                               (double)plumb_vec2_magnitude(cast.translation);
                assert_true(error <= (IS_DOUBLE ? 1e-9 : 1e-5));
            }
        }
        plumb_world_destroy(world);
    }
}

static void test_batches(void **state)
{
    (void)state;
    plumb_world *world = random_world(3, 80, 12, V(0, 0));
    plumb_convex shapes[4];
    plumb_cast casts[100];
    plumb_ray rays[100];
    plumb_vec2 points[100];
    for (int i = 0; i < 4; ++i) {
        shapes[i] = random_convex(0.6);
    }
    for (int i = 0; i < 100; ++i) {
        plumb_transform t = random_place(20);
        plumb_vec2 way = V(uniform(-9, 9), uniform(-9, 9));
        casts[i] = (plumb_cast){ &shapes[i / 25], t, way };
        rays[i] = (plumb_ray){ t.p, plumb_vec2_add(t.p, way) };
        points[i] = t.p;
    }
    plumb_cast_hit cast_hits[100], cast_hit;
    plumb_ray_hit ray_hits[100], ray_hit;
    plumb_nearest_hit near_hits[100], near_hit;
    const plumb_query_filter filter = { .ignore_dynamic = true };
    int met_casts = 0, met_rays = 0, met_points = 0;
    assert_int_equal(plumb_world_cast_batch(world, casts, 0, NULL, NULL), 0);
    assert_int_equal(plumb_world_ray_batch(world, rays, 0, NULL, NULL), 0);
    assert_int_equal(plumb_world_nearest_batch(world, points, 0, 1, NULL, NULL), 0);
    int casts_met = plumb_world_cast_batch(world, casts, 100, &filter, cast_hits);
    int rays_met = plumb_world_ray_batch(world, rays, 100, &filter, ray_hits);
    int points_met = plumb_world_nearest_batch(world, points, 100, 3, &filter, near_hits);
    for (int i = 0; i < 100; ++i) {
        bool met = plumb_world_cast(world, &casts[i], &filter, &cast_hit);
        cast_hit = met ? cast_hit : (plumb_cast_hit){ .fraction = 1 };
        assert_memory_equal(&cast_hits[i], &cast_hit, sizeof cast_hit);
        met_casts += met;
        met = plumb_world_ray(world, rays[i].from, rays[i].to, &filter, &ray_hit);
        ray_hit = met ? ray_hit : (plumb_ray_hit){ .fraction = 1 };
        assert_memory_equal(&ray_hits[i], &ray_hit, sizeof ray_hit);
        assert_int_equal(plumb_world_ray_any(world, rays[i].from, rays[i].to, &filter), met);
        met_rays += met;
        met = plumb_world_nearest(world, points[i], 3, &filter, &near_hit);
        near_hit = met ? near_hit : (plumb_nearest_hit){ .distance = 3 };
        assert_memory_equal(&near_hits[i], &near_hit, sizeof near_hit);
        met_points += met;
    }
    assert_true(casts_met == met_casts && rays_met == met_rays && points_met == met_points);
    assert_true(met_casts > 15 && met_rays > 12 && met_points > 20);
    plumb_world_destroy(world);
}

static void test_nearest_all(void **state)
{
    (void)state;
    plumb_world *world = random_world(9, 70, 10, V(0, 0));
    static plumb_nearest_hit hits[MOST];
    plumb_shape shapes[MOST];
    int shape_count = plumb_world_shapes(world, shapes, MOST);
    for (int i = 0; i < 60; ++i) {
        plumb_vec2 point = random_place(12).p;
        double reach = i == 0 ? 1e30 : uniform(0.1, 6);
        int count = plumb_world_nearest_all(world, point, R(reach), NULL, hits, MOST);
        int expected = 0;
        for (int k = 0; k < shape_count; ++k) {
            double least = HUGE_VAL;
            plumb_body body = plumb_shape_body(world, shapes[k]);
            plumb_vec2 local = plumb_body_local_point(world, body, point);
            for (int j = 0; j < plumb_shape_piece_count(world, shapes[k]); ++j) {
                plumb_convex piece;
                plumb_shape_piece(world, shapes[k], j, &piece, NULL);
                least = fmin(least, (double)plumb_convex_nearest(&piece, local).distance);
            }
            expected += least <= reach;
        }
        assert_int_equal(count, expected);
        plumb_nearest_hit nearest;
        bool met = plumb_world_nearest(world, point, R(reach), NULL, &nearest);
        assert_int_equal(met, count > 0);
        assert_true(!met || nearest.distance == hits[0].distance);
        for (int k = 1; k < count; ++k) {
            assert_true(hits[k - 1].distance <= hits[k].distance);
        }
    }
    plumb_world_destroy(world);
}

// What rays and casts see of one-way shapes: all of them, or what would hold.
static void test_one_way_filter(void **state)
{
    (void)state;
    plumb_world *world = NULL;
    plumb_world_create(NULL, &world);
    plumb_body base = plumb_body_create(world, &(plumb_body_desc){ .type = PLUMB_STATIC });
    plumb_shape_create(world, base,
                       &(plumb_shape_desc){ .kind = PLUMB_BOX,
                                            .half = { 2, R(0.1) },
                                            .one_way = { .direction = { 0, 3 } } });
    plumb_convex ball;
    plumb_convex_circle(V(0, 0), R(0.5), &ball);
    plumb_query_filter filter = { .one_way = true };
    plumb_cast down = { &ball, plumb_transform_make(V(0, 3), 0), V(0, -6) };
    plumb_cast up = { &ball, plumb_transform_make(V(0, -3), 0), V(0, 6) };
    plumb_cast in = { &ball, plumb_transform_make(V(0, R(0.3)), 0), V(0, -1) };
    plumb_cast side = { &ball, plumb_transform_make(V(-4, 0), 0), V(8, 0) };
    plumb_cast_hit hit;
    assert_true(plumb_world_cast(world, &down, &filter, &hit) && hit.normal.y == 1);
    assert_true(plumb_world_cast(world, &up, NULL, &hit) && hit.normal.y == -1);
    assert_false(plumb_world_cast(world, &up, &filter, &hit));
    assert_false(plumb_world_cast(world, &side, &filter, &hit));
    assert_false(plumb_world_cast(world, &in, &filter, &hit));
    assert_true(plumb_world_cast(world, &in, NULL, &hit) && hit.depth > 0);
    assert_true(plumb_world_ray_any(world, V(0, 3), V(0, -3), &filter));
    assert_false(plumb_world_ray_any(world, V(0, -3), V(0, 3), &filter));
    assert_false(plumb_world_ray_any(world, V(0, 0), V(0, 3), &filter));
    assert_true(plumb_world_ray_any(world, V(0, -3), V(0, 3), NULL));
    assert_int_equal(plumb_world_cast_all(world, &up, &filter, &hit, 1), 0);
    plumb_world_destroy(world);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_sum_against_sampling),
        cmocka_unit_test(test_touching),
        cmocka_unit_test(test_no_way),
        cmocka_unit_test(test_thin_sums),
        cmocka_unit_test(test_worlds),
        cmocka_unit_test(test_far_from_origin),
        cmocka_unit_test(test_batches),
        cmocka_unit_test(test_nearest_all),
        cmocka_unit_test(test_one_way_filter),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
