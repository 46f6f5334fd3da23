// test_query_extremes.c - questions with the largest, the smallest and the oddest numbers, in worlds of every kind:
// each is refused or answered, in work that does not grow with the number, and rightly where brute force knows.
//
// Work is counted by an allocator that ends; a loop that neither allocates nor asks ends by SIGXCPU.
#include "query_model.h"

#include <sys/resource.h>

#include "harness/heap.h"

#define CPU_LIMIT 240 // [s] some 100 times what all of it takes
#define HITS      64

// All that a coordinate may be.
static const double odd[] = { 0,    -0.0,  4.9e-324, 1e-45, -1e-40, 1e-30, 1e-9,  1,
                              -2.5, 7.75,  1e3,      -1e5,  1e7,    1e9,   -1e12, 1.0001e12,
                              1e15, -1e18, 1e30,     -1e30, 3.4e38, 1e300, 0.05,  -16 };

#define ODD ((int)(sizeof odd / sizeof odd[0]))

static plumb_real number(void)
{
    double v = odd[(int)uniform(0, ODD - 0.001)];
    double most = (double)PLUMB_REAL_MAX;
    return R(v > most ? most : v < -most ? -most : v);
}

static plumb_vec2 point(void)
{
    return uniform(0, 1) < 0.3 ? place(10) : plumb_v2(number(), number());
}

static plumb_aabb box(void)
{
    plumb_vec2 a = point(), b = point();
    return (plumb_aabb){ { plumb_min(a.x, b.x), plumb_min(a.y, b.y) },
                         { plumb_max(a.x, b.x), plumb_max(a.y, b.y) } };
}

static bool is_far(plumb_vec2 p)
{
    return plumb_abs(p.x) > PL_QUERY_LIMIT || plumb_abs(p.y) > PL_QUERY_LIMIT;
}

//---- worlds --------------------------------------------------------------------------------------

typedef struct kind {
    double wrap_x, wrap_y, reach, least, most; // [m]
    int bodies;
} kind;

static const kind kinds[] = {
    { 0, 0, 10, 0.1, 1, 0 },
    { 0, 0, 10, 0.1, 1, 1 },
    { 0, 0, 10, 0.1, 1, 30 },
    { 0, 0, 1e9, 1e-3, 1e6, 30 },
    { 0, 0, 1e8, 1e4, 9e6, 20 },
    { 0, 0, 1, 1e-3, 2e-3, 40 },
    { 16, 0, 8, 0.1, 1, 30 },
    { 0, 16, 8, 0.1, 1, 30 },
    { 16, 10, 8, 0.1, 1, 30 },
    { 16, 10, 8, 0.1, 1, 0 },
    { 16, 0, 8, 0.1, 1, 1 },
    { 0.1, 0.1, 0.05, 2e-3, 8e-3, 20 },
    { 0.1, 2e9, 0.05, 2e-3, 8e-3, 20 },
    { 2e9, 2e9, 9e8, 1e4, 1e7, 20 },
    { 1e6, 0, 5e5, 0.01, 1e5, 30 },
};
#define KINDS ((int)(sizeof kinds / sizeof kinds[0]))

static plumb_world *world_of(const kind *k, uint32_t seed, heap *h)
{
    random_state = seed * 2654435761u + 1;
    plumb_world *world = NULL;
    plumb_world_desc desc = { .zero_gravity = true,
                              .wrap_x = R(k->wrap_x),
                              .wrap_y = R(k->wrap_y),
                              .allocator = heap_allocator(h) };
    assert_int_equal(plumb_world_create(&desc, &world), PLUMB_OK);
    for (int i = 0; i < k->bodies; ++i) {
        plumb_body body =
            add_body(world, (plumb_body_type)(i % 3), place(k->reach), uniform(-4, 4));
        // An outline is left out: its pieces need no test of large numbers of their own.
        const int of[] = { PLUMB_CIRCLE, PLUMB_CAPSULE, PLUMB_BOX, PLUMB_POLYGON, PLUMB_SEGMENT };
        add_shape(world, body, of[(int)uniform(0, 4.999)], spread(k->least, k->most));
    }
    return world;
}

static bool wraps(const plumb_world *world)
{
    return world->desc.wrap_x > 0 || world->desc.wrap_y > 0;
}

//---- what is known -------------------------------------------------------------------------------

// 1: some image of [low, high] meets [from, to] for sure, -1: none does, 0: too close to tell.
static int meets_along(double low, double high, double from, double to, double period)
{
    double band = 1e-5 * (fabs(low) + fabs(high) + period) + 1e-9;
    if (period > 0) {
        if (to - from >= period) {
            return 1;
        }
        band += 1e-6 * (fabs(from) + fabs(to));
        double shift = floor((from - low) / period) * period, best = -HUGE_VAL;
        for (int k = -1; k <= 2; ++k) {
            double at = shift + k * period;
            double in = fmin(high + at, to) - fmax(low + at, from);
            best = fmax(best, in);
        }
        return best > band ? 1 : best < -band ? -1 : 0;
    }
    return high >= from && low <= to ? 1 : -1;
}

static void check_box(plumb_world *world, plumb_aabb b)
{
    plumb_shape shapes[HITS];
    int count = plumb_world_overlap_aabb(world, b, NULL, shapes, HITS);
    assert_in_range(count, 0, HITS);
    for (uint32_t p = 0; p < world->pieces.table.count; ++p) {
        pl_box t = pl_piece_tight_box(world, p);
        int x = meets_along((double)t.min_x, (double)t.max_x, (double)b.min.x, (double)b.max.x,
                            (double)world->desc.wrap_x);
        int y = meets_along((double)t.min_y, (double)t.max_y, (double)b.min.y, (double)b.max.y,
                            (double)world->desc.wrap_y);
        bool found = false;
        for (int i = 0; i < count; ++i) {
            found |= plumb_same(shapes[i], world->pieces.shape[p]);
        }
        if ((found && (x < 0 || y < 0)) || (!found && x > 0 && y > 0)) {
            fail_msg("wrap %g %g: box %.9g %.9g to %.9g %.9g and piece %.9g %.9g to %.9g %.9g: %d",
                     (double)world->desc.wrap_x, (double)world->desc.wrap_y, (double)b.min.x,
                     (double)b.min.y, (double)b.max.x, (double)b.max.y, (double)t.min_x,
                     (double)t.min_y, (double)t.max_x, (double)t.max_y, found);
        }
    }
}

// All there is, sorted, and the first of it is the nearest.
static void check_all_near(plumb_world *world, plumb_vec2 at, plumb_real most)
{
    plumb_nearest_hit hits[HITS], best;
    int count = plumb_world_nearest_all(world, at, most, NULL, hits, HITS);
    bool met = plumb_world_nearest(world, at, most, NULL, &best);
    if (is_far(at) || !(most > 0)) {
        assert_int_equal(count, -1);
        assert_false(met);
        return;
    }
    assert_int_equal(met, count > 0);
    // By which image is looked shows in the last digits.
    double size = fabs((double)at.x) + fabs((double)at.y) + (double)world->desc.wrap_x +
                  (double)world->desc.wrap_y + (count > 0 ? fabs((double)best.distance) : 0);
    if (count > 0) {
        assert_near(hits[0].distance, best.distance, 16 * (double)PLUMB_REAL_EPSILON * size);
    }
    for (int i = 1; i < count; ++i) {
        assert_true(hits[i].distance >= hits[i - 1].distance);
    }
    // Without an end, no farther than the limit and what bodies reach beyond it.
    if (most >= R(3e12)) {
        assert_int_equal(count, plumb_world_shapes(world, NULL, 0));
    }
}

// From whole periods away the same, as far as the numbers go.
static void check_inside(plumb_world *world, plumb_vec2 at)
{
    plumb_shape a[HITS], b[HITS];
    int count = plumb_world_overlap_point(world, at, NULL, a, HITS);
    assert_int_equal(count < 0, is_far(at));
    if (count >= 0 && wraps(world)) {
        assert_int_equal(
            plumb_world_overlap_point(world, plumb_world_wrapped(world, at), NULL, b, HITS), count);
        assert_memory_equal(a, b, (size_t)count * sizeof *a);
    }
}

static bool too_long(const plumb_world *world, plumb_vec2 way)
{
    return (world->desc.wrap_x > 0 && plumb_abs(way.x) > 8 * world->desc.wrap_x) ||
           (world->desc.wrap_y > 0 && plumb_abs(way.y) > 8 * world->desc.wrap_y);
}

static void check_way(plumb_world *world, plumb_vec2 from, plumb_vec2 to)
{
    plumb_ray_hit hits[HITS], hit;
    int count = plumb_world_ray_all(world, from, to, NULL, hits, HITS);
    bool met = plumb_world_ray(world, from, to, NULL, &hit);
    assert_int_equal(plumb_world_ray_any(world, from, to, NULL), met);
    assert_int_equal(plumb_world_ray_batch(world, &(plumb_ray){ from, to }, 1, NULL, hits),
                     count < 0 ? -1 : met);
    bool refused = is_far(from) || is_far(to);
    if (refused) {
        assert_int_equal(count, -1);
    } else if (!wraps(world)) {
        check_ray(world, from, to, NULL);
    } else if (too_long(world, plumb_vec2_sub(to, from))) {
        assert_int_equal(count, -1);
    } else {
        assert_int_equal(met, count > 0);
    }
}

static void check_cast(plumb_world *world, plumb_vec2 from, plumb_vec2 way, double size)
{
    plumb_convex convex;
    plumb_cast cast = { &convex, { from, plumb_rot_make(R(uniform(-3, 3))) }, way };
    plumb_cast_hit hits[HITS], hit;
    plumb_shape shapes[HITS];
    if (plumb_convex_box(V(size, size / 2), V(0, 0), 0, 0, &convex) != PLUMB_OK) {
        return;
    }
    int count = plumb_world_cast_all(world, &cast, NULL, hits, HITS);
    bool met = plumb_world_cast(world, &cast, NULL, &hit);
    assert_int_equal(plumb_world_cast_any(world, &cast, NULL), met);
    assert_int_equal(plumb_world_cast_batch(world, &cast, 1, NULL, hits), count < 0 ? -1 : met);
    assert_true(count >= 0 ? met == (count > 0) : !met);
    assert_true(count < 0 || !(is_far(from) || is_far(way) || too_long(world, way)));
    int lies = plumb_world_overlap_convex(world, &convex, cast.transform, NULL, shapes, HITS);
    assert_true(lies >= -1 && lies <= HITS);
}

static void ask_everything(plumb_world *world)
{
    plumb_vec2 a = point(), b = point();
    check_box(world, box());
    check_inside(world, a);
    check_all_near(world, a, number());
    check_all_near(world, a, PLUMB_REAL_MAX);
    check_way(world, a, b);
    check_way(world, a, plumb_vec2_add(a, place(10)));
    check_cast(world, a, b, spread(0.01, 1e7));
    check_cast(world, a, place(10), spread(0.01, 3));
    plumb_explosion_desc blast = { .position = a,
                                   .radius = number(),
                                   .falloff = number(),
                                   .impulse = uniform(0, 1) < 0.5 ? 0 : number() };
    plumb_result r = plumb_world_explode(world, &blast);
    assert_true(r == PLUMB_OK || r == PLUMB_E_RANGE || r == PLUMB_E_NOT_FINITE);
}

static void limit_cpu(void)
{
    struct rlimit most;
    assert_int_equal(getrlimit(RLIMIT_CPU, &most), 0);
    most.rlim_cur = CPU_LIMIT;
    assert_int_equal(setrlimit(RLIMIT_CPU, &most), 0);
}

static void every_question_is_answered(void **state)
{
    (void)state;
    limit_cpu();
    for (int i = 0; i < KINDS; ++i) {
        heap h = HEAP_INIT;
        h.limit = 8 * 1024 * 1024; // [B]
        for (uint32_t seed = 1; seed <= 8; ++seed) {
            plumb_world *world = world_of(&kinds[i], seed, &h);
            for (int k = 0; k < 100; ++k) {
                ask_everything(world);
            }
            plumb_world_destroy(world);
        }
        assert_int_equal(h.refused, 0);
        assert_int_equal(h.bytes, 0);
    }
}

// The one that was found first.
static void a_box_of_1e17_periods_is_one_of_all(void **state)
{
    (void)state;
    limit_cpu();
    heap h = HEAP_INIT;
    h.limit = 8 * 1024 * 1024; // [B]
    plumb_world *world = world_of(&kinds[8], 1, &h);
    const double far[] = { -1e18, -1e15, -3e38 };
    for (int i = 0; i < 3; ++i) {
        plumb_shape shapes[HITS];
        plumb_aabb b = { V(far[i], far[i]), V(1, 1) };
        assert_int_equal(plumb_world_overlap_aabb(world, b, NULL, shapes, HITS), 30);
        b = (plumb_aabb){ V(1, 1), V(-far[i], -far[i]) };
        assert_int_equal(plumb_world_overlap_aabb(world, b, NULL, shapes, HITS), 30);
    }
    plumb_world_destroy(world);
    assert_int_equal(h.refused, 0);
}

//---- wide casts ----------------------------------------------------------------------------------

// Each row of cells under a wide thing is as wide as the thing: where cells are more than what lies in them, they
// are not gone through. Row by row these casts take some 100 times the limit.
static void a_wide_cast_costs_no_more_than_all_there_is(void **state)
{
    (void)state;
    limit_cpu();
    plumb_world *world = make_world(1);
    for (int i = 0; i < 50000; ++i) {
        add_shape(world, add_body(world, PLUMB_STATIC, V(i, i), 0), PLUMB_CIRCLE, 0.4);
    }
    plumb_convex convex;
    assert_int_equal(plumb_convex_box(V(15000, 15000), V(0, 0), 0, 0, &convex), PLUMB_OK);
    plumb_cast cast = { &convex, { V(25000, 25000), { 1, 0 } }, V(1, 1) };
    plumb_query_filter none = { .mask = UINT64_C(1) << 40 };
    plumb_cast_hit hit;
    for (int i = 0; i < 400; ++i) {
        assert_false(plumb_world_cast(world, &cast, &none, &hit));
    }
    assert_true(plumb_world_cast_all(world, &cast, NULL, &hit, 1) >= 30000);
    plumb_world_destroy(world);
}

//---- steps ---------------------------------------------------------------------------------------

// What flies so fast that its way is 1e13 periods long.
static void every_step_ends(void **state)
{
    (void)state;
    limit_cpu();
    for (int i = 0; i < KINDS; ++i) {
        heap h = HEAP_INIT;
        h.limit = 32 * 1024 * 1024; // [B]
        for (uint32_t seed = 1; seed <= 6; ++seed) {
            plumb_world *world = world_of(&kinds[i], seed, &h);
            plumb_body bodies[HITS];
            int count = 0;
            for (uint32_t p = 0; p < world->pieces.table.count; ++p) {
                plumb_body body = plumb_shape_body(world, world->pieces.shape[p]);
                bodies[count++] = body;
                if (plumb_body_get_type(world, body) != PLUMB_STATIC) {
                    plumb_body_set_continuous(world, body, p % 2 == 0);
                    plumb_body_set_velocity(world, body, point());
                    plumb_body_set_angular_velocity(world, body, number());
                }
            }
            for (int step = 0; step < 5; ++step) {
                plumb_world_step(world, R(1.0 / 60));
            }
            for (int k = 0; k < count; ++k) {
                assert_true(plumb_vec2_is_finite(plumb_body_position(world, bodies[k])));
                assert_true(plumb_vec2_is_finite(plumb_body_velocity(world, bodies[k])));
            }
            plumb_world_destroy(world);
        }
        assert_int_equal(h.refused, 0);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_box_of_1e17_periods_is_one_of_all),
        cmocka_unit_test(every_question_is_answered),
        cmocka_unit_test(a_wide_cast_costs_no_more_than_all_there_is),
        cmocka_unit_test(every_step_ends),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
