// test_wrap.c - a world that wraps around against one without an end in which everything stands many times: pairs,
// rays, casts, overlaps, nearest shapes; and shifts by whole periods.
#include "harness/near.h"
#include "event/event.h"
#include "broad/broad.h"
#include "broad/grid.h"
#include "harness/random.h"
#include "plumb/plumb.h"
#include "world/wrap.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>
#include <cmocka.h>

#define R(x) ((plumb_real)(x))

#define PERIOD_X 16.0
#define PERIOD_Y 10.0
#define COPIES   2 // to either side
#define SHAPES   40

typedef struct pair_of_worlds {
    plumb_world *wrapped, *plain;
    double wrap_x, wrap_y;
} pair_of_worlds;

static plumb_shape put(plumb_world *w, plumb_vec2 at, plumb_real angle, int i,
                       const plumb_shape_desc *shape)
{
    plumb_body body = plumb_body_create(
        w, &(plumb_body_desc){ .type = PLUMB_STATIC, .position = at, .angle = angle });
    plumb_shape_desc d = *shape;
    d.user_data = (void *)(intptr_t)(i + 1);
    plumb_shape made = plumb_shape_create(w, body, &d);
    assert_false(plumb_is_null(made));
    return made;
}

// Shapes of all kinds, off their bodies' origins too.
static plumb_shape_desc some_shape(uint32_t *seed, plumb_vec2 points[4])
{
    double size = sim_uniform(seed, 0.05, 0.7);
    double ox = sim_uniform(seed, -1, 1), oy = sim_uniform(seed, -1, 1);
    switch ((int)sim_uniform(seed, 0, 4)) {
    case 0:
        return (plumb_shape_desc){ .kind = PLUMB_CIRCLE,
                                   .radius = R(size),
                                   .center = { R(ox), R(oy) } };
    case 1:
        points[0] = plumb_v2(R(ox - size), R(oy));
        points[1] = plumb_v2(R(ox + size), R(oy + size));
        return (plumb_shape_desc){
            .kind = PLUMB_CAPSULE, .points = points, .count = 2, .radius = R(0.1)
        };
    case 2:
        return (plumb_shape_desc){ .kind = PLUMB_BOX,
                                   .half = { R(size), R(size / 2) },
                                   .center = { R(ox), R(oy) } };
    default:
        points[0] = plumb_v2(R(ox), R(oy));
        points[1] = plumb_v2(R(ox + size), R(oy));
        points[2] = plumb_v2(R(ox), R(oy + size));
        return (plumb_shape_desc){
            .kind = PLUMB_POLYGON, .points = points, .count = 3, .radius = R(0.05)
        };
    }
}

static void make_worlds(pair_of_worlds *p, uint32_t *seed, bool along_x, bool along_y)
{
    p->wrap_x = along_x ? PERIOD_X : 0;
    p->wrap_y = along_y ? PERIOD_Y : 0;
    plumb_world_desc desc = { .wrap_x = R(p->wrap_x), .wrap_y = R(p->wrap_y) };
    assert_int_equal(plumb_world_create(&desc, &p->wrapped), PLUMB_OK);
    assert_int_equal(plumb_world_create(NULL, &p->plain), PLUMB_OK);
    for (int i = 0; i < SHAPES; ++i) {
        plumb_vec2 points[4];
        plumb_shape_desc shape = some_shape(seed, points);
        double x = sim_uniform(seed, -8, 8), y = sim_uniform(seed, -5, 5);
        plumb_real angle = R(sim_uniform(seed, -3, 3));
        put(p->wrapped, plumb_v2(R(x), R(y)), angle, i, &shape);
        for (int kx = -COPIES; kx <= COPIES; ++kx) {
            for (int ky = -COPIES; ky <= COPIES; ++ky) {
                if ((kx == 0 || along_x) && (ky == 0 || along_y)) {
                    put(p->plain, plumb_v2(R(x + kx * PERIOD_X), R(y + ky * PERIOD_Y)), angle, i,
                        &shape);
                }
            }
        }
    }
}

static void drop_worlds(pair_of_worlds *p)
{
    plumb_world_destroy(p->wrapped);
    plumb_world_destroy(p->plain);
}

static uint64_t bit_of(const plumb_world *w, plumb_shape shape)
{
    return UINT64_C(1) << ((intptr_t)plumb_shape_user_data(w, shape) - 1);
}

static plumb_vec2 some_point(uint32_t *seed)
{
    return plumb_v2(R(sim_uniform(seed, -8, 8)), R(sim_uniform(seed, -5, 5)));
}

// Float coordinates to 40 m: what both worlds make of them differs by so much.
#define NEAR 1e-4

static void each_way(void (*check)(pair_of_worlds *p, uint32_t *seed))
{
    uint32_t seed = 1;
    for (int round = 0; round < 6; ++round) {
        pair_of_worlds p;
        make_worlds(&p, &seed, round % 3 != 1, round % 3 != 0);
        for (int i = 0; i < 100; ++i) {
            check(&p, &seed);
        }
        drop_worlds(&p);
    }
}

static void check_ray(pair_of_worlds *p, uint32_t *seed)
{
    plumb_vec2 from = some_point(seed);
    plumb_vec2 to = { from.x + R(sim_uniform(seed, -20, 20)),
                      from.y + R(sim_uniform(seed, -12, 12)) };
    plumb_ray_hit a, b;
    bool met_a = plumb_world_ray(p->wrapped, from, to, NULL, &a);
    bool met_b = plumb_world_ray(p->plain, from, to, NULL, &b);
    assert_int_equal(met_a, met_b);
    assert_int_equal(plumb_world_ray_any(p->wrapped, from, to, NULL), met_b);
    if (met_a) {
        assert_near(a.fraction, b.fraction, NEAR);
        assert_near(a.point.x, b.point.x, NEAR * 20);
        assert_near(a.point.y, b.point.y, NEAR * 20);
    }
    plumb_ray_hit all[SHAPES], many[SHAPES * 25];
    int count = plumb_world_ray_all(p->wrapped, from, to, NULL, all, SHAPES);
    int plain = plumb_world_ray_all(p->plain, from, to, NULL, many, SHAPES * 25);
    uint64_t in_a = 0, in_b = 0;
    for (int i = 0; i < count; ++i) {
        in_a |= bit_of(p->wrapped, all[i].shape);
        assert_true(i == 0 || all[i].fraction >= all[i - 1].fraction);
    }
    for (int i = 0; i < plain; ++i) {
        in_b |= bit_of(p->plain, many[i].shape);
    }
    assert_true(in_a == in_b);
}

static void rays_go_over_the_edge(void **state)
{
    (void)state;
    each_way(check_ray);
}

static void check_cast(pair_of_worlds *p, uint32_t *seed)
{
    plumb_convex box;
    plumb_convex_box(plumb_v2(R(0.3), R(0.2)), plumb_v2(0, 0), R(0.3), R(0.05), &box);
    plumb_cast cast = { .convex = &box,
                        .transform = { some_point(seed), { 1, 0 } },
                        .translation = { R(sim_uniform(seed, -20, 20)),
                                         R(sim_uniform(seed, -12, 12)) } };
    plumb_cast_hit a, b;
    bool met_a = plumb_world_cast(p->wrapped, &cast, NULL, &a);
    bool met_b = plumb_world_cast(p->plain, &cast, NULL, &b);
    assert_int_equal(met_a, met_b);
    if (met_a) {
        assert_near(a.fraction, b.fraction, NEAR);
        assert_near(a.point.x, b.point.x, ROUNDED(0.05));
        assert_near(a.point.y, b.point.y, ROUNDED(0.05));
    }
}

static void casts_go_over_the_edge(void **state)
{
    (void)state;
    each_way(check_cast);
}

static uint64_t bits_of(const plumb_world *w, const plumb_shape *shapes, int count)
{
    uint64_t bits = 0;
    for (int i = 0; i < count; ++i) {
        bits |= bit_of(w, shapes[i]);
    }
    return bits;
}

static void check_overlap(pair_of_worlds *p, uint32_t *seed)
{
    plumb_shape a[SHAPES], b[SHAPES * 25];
    plumb_vec2 at = some_point(seed);
    plumb_real w = R(sim_uniform(seed, 0, 3)), h = R(sim_uniform(seed, 0, 3));
    plumb_aabb box = { { at.x - w, at.y - h }, { at.x + w, at.y + h } };
    int count = plumb_world_overlap_aabb(p->wrapped, box, NULL, a, SHAPES);
    int plain = plumb_world_overlap_aabb(p->plain, box, NULL, b, SHAPES * 25);
    assert_true(bits_of(p->wrapped, a, count) == bits_of(p->plain, b, plain));
    plumb_convex convex;
    plumb_convex_box(plumb_v2(w + R(0.1), h + R(0.1)), plumb_v2(0, 0), R(0.7), 0, &convex);
    plumb_transform t = { at, { 1, 0 } };
    count = plumb_world_overlap_convex(p->wrapped, &convex, t, NULL, a, SHAPES);
    plain = plumb_world_overlap_convex(p->plain, &convex, t, NULL, b, SHAPES * 25);
    assert_true(bits_of(p->wrapped, a, count) == bits_of(p->plain, b, plain));
    count = plumb_world_overlap_point(p->wrapped, at, NULL, a, SHAPES);
    plain = plumb_world_overlap_point(p->plain, at, NULL, b, SHAPES * 25);
    assert_true(bits_of(p->wrapped, a, count) == bits_of(p->plain, b, plain));
    plumb_aabb all = { { -1000, -1000 }, { 1000, 1000 } };
    assert_int_equal(plumb_world_overlap_aabb(p->wrapped, all, NULL, a, SHAPES), SHAPES);
}

static void overlaps_go_over_the_edge(void **state)
{
    (void)state;
    each_way(check_overlap);
}

// Whatever the image, and however far from the origin of its body a shape lies.
static void shapes_contain_points_over_the_edge(void **state)
{
    (void)state;
    plumb_world *world = NULL;
    const plumb_world_desc desc = { .wrap_x = R(PERIOD_X), .wrap_y = R(PERIOD_Y) };
    assert_int_equal(plumb_world_create(&desc, &world), PLUMB_OK);
    uint32_t seed = 7;
    int met = 0;
    for (int i = 0; i < 400; ++i) {
        plumb_body body = plumb_body_create(
            world, &(plumb_body_desc){
                       .type = PLUMB_STATIC, .position = some_point(&seed), .angle = R(i) });
        const plumb_shape_desc ball = { .kind = PLUMB_CIRCLE,
                                        .radius = R(0.5),
                                        .center = { R(sim_uniform(&seed, -3, 3) * PERIOD_X),
                                                    R(sim_uniform(&seed, -3, 3) * PERIOD_Y) } };
        plumb_shape shape = plumb_shape_create(world, body, &ball), found;
        plumb_vec2 at = plumb_body_world_point(world, body, ball.center);
        at.x += R(sim_uniform(&seed, -0.6, 0.6)), at.y += R(sim_uniform(&seed, -0.6, 0.6));
        const int count = plumb_world_overlap_point(world, at, NULL, &found, 1);
        assert_int_equal(plumb_shape_contains(world, shape, at), count == 1);
        met += count;
        assert_int_equal(plumb_body_destroy(world, body), PLUMB_OK);
    }
    assert_true(met > 100);
    plumb_world_destroy(world);
}

static void check_nearest(pair_of_worlds *p, uint32_t *seed)
{
    plumb_vec2 at = some_point(seed);
    // Asked from another period, it is the same place.
    plumb_vec2 far = { at.x + R(3 * p->wrap_x), at.y - R(2 * p->wrap_y) };
    plumb_nearest_hit a, b;
    assert_true(plumb_world_nearest(p->wrapped, far, 100, NULL, &a));
    assert_true(plumb_world_nearest(p->plain, at, 100, NULL, &b));
    assert_near(a.distance, b.distance, NEAR);
    double dx = (double)(a.point.x - far.x), dy = (double)(a.point.y - far.y);
    assert_near(sqrt(dx * dx + dy * dy), fabs((double)b.distance), NEAR);
    plumb_nearest_hit some[SHAPES], many[SHAPES * 25];
    plumb_real reach = R(sim_uniform(seed, 0.1, 4));
    int count = plumb_world_nearest_all(p->wrapped, at, reach, NULL, some, SHAPES);
    int plain = plumb_world_nearest_all(p->plain, at, reach, NULL, many, SHAPES * 25);
    uint64_t in_a = 0, in_b = 0;
    for (int i = 0; i < count; ++i) {
        in_a |= bit_of(p->wrapped, some[i].shape);
    }
    for (int i = 0; i < plain; ++i) {
        in_b |= bit_of(p->plain, many[i].shape);
    }
    assert_true(in_a == in_b);
}

static void nearest_goes_over_the_edge(void **state)
{
    (void)state;
    each_way(check_nearest);
}

//---- pairs ---------------------------------------------------------------------------------------

static bool overlap_somewhere(const plumb_world *w, const pl_box *a, const pl_box *b)
{
    for (int kx = -1; kx <= 1; ++kx) {
        for (int ky = -1; ky <= 1; ++ky) {
            plumb_real x = R(kx) * w->desc.wrap_x, y = R(ky) * w->desc.wrap_y;
            pl_box at = { a->min_x + x, a->min_y + y, a->max_x + x, a->max_y + y };
            if (pl_boxes_overlap(&at, b)) {
                return true;
            }
        }
    }
    return false;
}

static void every_pair_over_the_edge_once(void **state)
{
    (void)state;
    uint32_t seed = 9;
    for (int round = 0; round < 30; ++round) {
        plumb_world *w;
        plumb_world_desc desc = { .wrap_x = round % 3 == 1 ? 0 : R(PERIOD_X),
                                  .wrap_y = round % 3 == 0 ? 0 : R(PERIOD_Y) };
        assert_int_equal(plumb_world_create(&desc, &w), PLUMB_OK);
        for (int i = 0; i < 80; ++i) {
            plumb_vec2 points[4];
            plumb_shape_desc shape = some_shape(&seed, points);
            plumb_body body = plumb_body_create(
                w, &(plumb_body_desc){ .type = (plumb_body_type)(i % 3),
                                       .position = some_point(&seed),
                                       .velocity = { R(sim_uniform(&seed, -5, 5)),
                                                     R(sim_uniform(&seed, -5, 5)) } });
            if (i % 3 == (int)PLUMB_STATIC) {
                plumb_body_set_velocity(w, body, plumb_v2(0, 0));
            }
            plumb_shape_create(w, body, &shape);
        }
        for (int step = 0; step < 20; ++step) {
            assert_true(pl_broad_update(w, R(1.0 / 60), &pl_end_listener));
            uint32_t expected = 0, count = w->broad.pairs.count;
            for (uint32_t p = 0; p < w->pieces.table.count; ++p) {
                for (uint32_t q = p + 1; q < w->pieces.table.count; ++q) {
                    bool dynamic = w->pieces.body[p] < w->dynamic_count ||
                                   w->pieces.body[q] < w->dynamic_count;
                    expected +=
                        dynamic && overlap_somewhere(w, &w->pieces.fat[p], &w->pieces.fat[q]);
                }
            }
            // No more than expected, none of them twice: a list in strict order.
            assert_int_equal(count, expected);
            for (uint32_t i = 1; i < count; ++i) {
                const pl_pair *a = &pl_pairs(&w->broad.pairs)[i - 1], *b = a + 1;
                assert_false(a->a == b->a && a->b == b->b);
            }
            assert_int_equal(plumb_world_step(w, R(1.0 / 60)), PLUMB_OK);
        }
        plumb_world_destroy(w);
    }
}

//---- shifts --------------------------------------------------------------------------------------

static void points_are_brought_back(void **state)
{
    (void)state;
    plumb_world *w;
    assert_int_equal(plumb_world_create(&(plumb_world_desc){ .wrap_x = 20 }, &w), PLUMB_OK);
    const double table[][2] = { { 0, 0 },       { 9.5, 9.5 },          { 10, -10 },   { -10, -10 },
                                { 10.5, -9.5 }, { -10.5, 9.5 },        { 29.5, 9.5 }, { 30, -10 },
                                { 1e6, 0 },     { -1e6 - 0.25, -0.25 } };
    for (size_t i = 0; i < sizeof table / sizeof table[0]; ++i) {
        plumb_vec2 p = plumb_world_wrapped(w, plumb_v2(R(table[i][0]), R(table[i][0])));
        assert_true(p.x == R(table[i][1]));
        assert_true(p.y == R(table[i][0]));
        plumb_body body = plumb_body_create(
            w, &(plumb_body_desc){ .position = { R(table[i][0]), R(table[i][0]) } });
        assert_true(plumb_body_position(w, body).x == R(table[i][1]));
        assert_true(plumb_body_position(w, body).y == R(table[i][0]));
    }
    plumb_vec2 way = plumb_world_way(w, plumb_v2(9, 9), plumb_v2(-9, -9));
    assert_true(way.x == 2 && way.y == -18);
    way = plumb_world_way(w, plumb_v2(-9, 0), plumb_v2(9, 0));
    assert_true(way.x == -2);
    // One real before the edge stays, and none comes out at the upper edge.
    plumb_real below = R(10) - 10 * PLUMB_REAL_EPSILON;
    assert_true(plumb_world_wrapped(w, plumb_v2(below, 0)).x == below);
    plumb_real beyond = R(-10) - 10 * PLUMB_REAL_EPSILON;
    plumb_real back = plumb_world_wrapped(w, plumb_v2(beyond, 0)).x;
    assert_true(back < 10 && back > R(9.99));
    plumb_world_destroy(w);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(rays_go_over_the_edge),
        cmocka_unit_test(casts_go_over_the_edge),
        cmocka_unit_test(overlaps_go_over_the_edge),
        cmocka_unit_test(shapes_contain_points_over_the_edge),
        cmocka_unit_test(nearest_goes_over_the_edge),
        cmocka_unit_test(every_pair_over_the_edge_once),
        cmocka_unit_test(points_are_brought_back),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
