// test_query.c - rays, filters and what changes between queries, against a model that asks every piece.
#include "query_model.h"

#define DT ((plumb_real)(1.0 / 60))

static void test_rays(void **state)
{
    (void)state;
    int met = 0;
    for (uint32_t seed = 1; seed <= 8; ++seed) {
        plumb_world *world = random_world(seed, 50 * (int)seed, 3 * sqrt(50.0 * seed), 0.1, 1);
        met += rays_of_all_kinds(world, 600, 4 * sqrt(50.0 * seed), NULL);
        plumb_world_destroy(world);
    }
    assert_true(met > 1000 && met < 8 * 600 - 500);
}

static void test_rays_mixed_sizes(void **state)
{
    (void)state;
    for (uint32_t seed = 1; seed <= 5; ++seed) {
        plumb_world *world = make_world(seed + 20);
        for (int i = 0; i < 200; ++i) {
            add_random(world, spread(0.1, 2000), 0.01, 300);
        }
        rays_of_all_kinds(world, 200, 3000, NULL);
        rays_of_all_kinds(world, 200, 1, NULL);
        plumb_world_destroy(world);
    }
}

// What is met is on the surface, and the normal shows out of it.
static void test_ray_hit(void **state)
{
    (void)state;
    plumb_world *world = make_world(1);
    plumb_body ball = add_body(world, PLUMB_DYNAMIC, V(10, 2), 1);
    plumb_shape circle = add_shape(world, ball, PLUMB_CIRCLE, 2);
    plumb_body ground = add_body(world, PLUMB_STATIC, V(0, -5), 0);
    plumb_shape_desc slab = { .kind = PLUMB_BOX, .half = { 50, 1 } };
    plumb_shape floor = plumb_shape_create(world, ground, &slab);
    plumb_ray_hit hit;
    assert_true(plumb_world_ray(world, V(0, 2), V(20, 2), NULL, &hit));
    assert_true(plumb_same(hit.shape, circle) && plumb_same(hit.body, ball));
    assert_near(hit.fraction, 0.4, ROUNDED(1e-6));
    assert_near(hit.point.x, 8, ROUNDED(1e-5));
    assert_near(hit.point.y, 2, ROUNDED(1e-5));
    assert_near(hit.normal.x, -1, ROUNDED(1e-6));
    assert_true(plumb_world_ray(world, V(3, 6), V(3, -14), NULL, &hit));
    assert_true(plumb_same(hit.shape, floor) && plumb_same(hit.body, ground));
    assert_near(hit.fraction, 0.5, ROUNDED(1e-6));
    assert_near(hit.normal.y, 1, ROUNDED(1e-6));
    assert_true(plumb_world_ray(world, V(10.5, 2), V(40, 2), NULL, &hit)); // from inside
    assert_true(plumb_same(hit.shape, circle));
    assert_true(hit.fraction == 0 && hit.normal.x == 0 && hit.normal.y == 0);
    assert_true(hit.point.x == R(10.5) && hit.point.y == 2);
    assert_false(plumb_world_ray(world, V(0, 2), V(7.9, 2), NULL, &hit)); // ends before
    assert_false(plumb_world_ray(world, V(0, 2), V(-20, 2), NULL, &hit)); // shows away
    assert_false(plumb_world_ray(world, V(0, 2), V(0, 2), NULL, &hit));   // goes nowhere
    assert_true(plumb_world_ray(world, V(10, 3), V(10, 3), NULL, &hit));  // inside
    plumb_world_destroy(world);
}

// Equal fractions: the lower slot, whatever the grid and the order of creation in it.
static void test_ray_ties(void **state)
{
    (void)state;
    for (int order = 0; order < 6; ++order) {
        plumb_world *world = make_world(1);
        plumb_shape shapes[3];
        for (int i = 0; i < 3; ++i) {
            plumb_body_type type = (plumb_body_type)((i + order) % 3);
            plumb_body body = add_body(world, type, V(3, 0), 0);
            shapes[i] = add_shape(world, body, PLUMB_CIRCLE, 1);
        }
        plumb_ray_hit hits[3], hit;
        assert_true(plumb_world_ray(world, V(0, 0), V(9, 0), NULL, &hit));
        assert_true(plumb_same(hit.shape, shapes[0]));
        assert_int_equal(plumb_world_ray_all(world, V(0, 0), V(9, 0), NULL, hits, 3), 3);
        for (int i = 0; i < 3; ++i) {
            assert_true(plumb_same(hits[i].shape, shapes[i]));
        }
        plumb_world_destroy(world);
    }
}

// More hits than the caller has room for: the first ones, and how many there are.
static void test_capacity(void **state)
{
    (void)state;
    plumb_world *world = make_world(2);
    plumb_shape made[100];
    for (int i = 0; i < 100; ++i) {
        plumb_body body = add_body(world, (plumb_body_type)(i % 3), V(100 - i, 0), 0);
        made[i] = add_shape(world, body, PLUMB_CIRCLE, 0.25);
    }
    size_t bytes = world->memory.bytes;
    plumb_ray_hit hits[101];
    plumb_shape shapes[101];
    plumb_aabb all = { { -1, -1 }, { 101, 1 } };
    for (int room = 0; room <= 101; room += room < 3 ? 1 : 49) {
        memset(hits, 77, sizeof hits);
        memset(shapes, 77, sizeof shapes);
        assert_int_equal(plumb_world_ray_all(world, V(0, 0), V(200, 0), NULL, hits, room), 100);
        assert_int_equal(plumb_world_overlap_aabb(world, all, NULL, shapes, room), 100);
        for (int i = 0; i < room && i < 100; ++i) {
            assert_true(plumb_same(hits[i].shape, made[99 - i]));
            assert_true(plumb_same(shapes[i], made[i]));
        }
        if (room < 101) {
            assert_int_equal(hits[room].shape.entity.index, 0x4d4d4d4d);
            assert_int_equal(shapes[room].entity.index, 0x4d4d4d4d);
        }
    }
    assert_int_equal(plumb_world_ray_all(world, V(0, 0), V(200, 0), NULL, NULL, 0), 100);
    assert_true(world->memory.bytes < bytes + 64 * 1024); // the lists are gone; the grids were made
    plumb_world_destroy(world);
}

//---- filters -------------------------------------------------------------------------------------
static bool accept_third(void *context, plumb_shape shape)
{
    int *calls = context;
    ++*calls;
    return shape.entity.index % 3 == 0;
}

static void test_filters(void **state)
{
    (void)state;
    plumb_world *world = random_world(5, 200, 15, 0.2, 1.5);
    plumb_body bodies[512];
    int calls = 0, count = 0;
    plumb_body_span span = plumb_world_bodies(world);
    for (; count < span.count && count < 512; ++count) {
        bodies[count] = span.body[count];
    }
    for (int i = 0; i < 64; ++i) {
        plumb_query_filter f = { .ignore_static = i & 1, .ignore_dynamic = (i >> 1) & 1 };
        if (i & 4) {
            f.ignore_body = bodies[(int)uniform(0, count - 0.001)];
        }
        if (i & 8) {
            f.accept = accept_third;
            f.context = &calls;
        }
        rays_of_all_kinds(world, 30, 15, &f);
        overlaps_of_all_kinds(world, 15, 15, 1, &f);
    }
    assert_true(calls > 1000);
    plumb_query_filter neither = { .ignore_static = true, .ignore_dynamic = true };
    plumb_aabb all = { { -99, -99 }, { 99, 99 } };
    assert_int_equal(plumb_world_overlap_aabb(world, all, &neither, NULL, 0), 0);
    plumb_world_destroy(world);
}

typedef struct inner {
    plumb_world *world;
    int asked;
} inner;

// A filter that asks another query, with more hits than fit on the stack.
static bool accept_crowded(void *context, plumb_shape shape)
{
    inner *in = context;
    plumb_shape shapes[64];
    plumb_aabb box = plumb_shape_aabb(in->world, shape);
    ++in->asked;
    return plumb_world_overlap_aabb(in->world, plumb_aabb_expand(box, 9), NULL, shapes, 64) > 40;
}

static void test_nested(void **state)
{
    (void)state;
    plumb_world *world = random_world(6, 250, 12, 0.2, 1);
    inner in = { world, 0 };
    plumb_query_filter f = { .accept = accept_crowded, .context = &in };
    rays_of_all_kinds(world, 50, 12, &f);
    overlaps_of_all_kinds(world, 20, 12, 8, &f);
    assert_true(in.asked > 500);
    plumb_world_destroy(world);
}

// Queries see shapes where they are now: made, moved and destroyed since the last step or query.
static void test_changes(void **state)
{
    (void)state;
    for (uint32_t seed = 1; seed <= 4; ++seed) {
        plumb_world *world = make_world(seed + 80);
        plumb_body bodies[MOST];
        int count = 0;
        for (int round = 0; round < 150; ++round) {
            double dice = uniform(0, 1);
            int chosen = (int)uniform(0, count - 0.001);
            if (count < 20 || dice < 0.3) {
                bodies[count++] = add_random(world, 6, 0.1, 1);
            } else if (dice < 0.45) {
                assert_int_equal(plumb_body_destroy(world, bodies[chosen]), PLUMB_OK);
                bodies[chosen] = bodies[--count];
            } else if (dice < 0.7) {
                plumb_body_teleport(world, bodies[chosen], place(6), R(uniform(-4, 4)));
            } else if (dice < 0.8) {
                add_shape(world, bodies[chosen], (int)uniform(0, 6.999), spread(0.1, 1));
            } else {
                assert_int_equal(plumb_world_step(world, DT), PLUMB_OK);
            }
            check_a_few(world, 7);
        }
        plumb_world_destroy(world);
    }
}

static void test_fast_bodies(void **state)
{
    (void)state;
    plumb_world *world = random_world(7, 150, 20, 0.2, 1);
    plumb_body_span span = plumb_world_bodies(world);
    for (int i = 0; i < span.dynamic_count; ++i) {
        plumb_body_set_velocity(world, span.body[i], place(500));
    }
    for (int step = 0; step < 30; ++step) {
        assert_int_equal(plumb_world_step(world, DT), PLUMB_OK);
        check_a_few(world, 20 + 10 * step);
    }
    plumb_world_destroy(world);
}

// Looking does not disturb: a world that is asked moves as one that is not, to the last bit.
static void test_motion_is_not_disturbed(void **state)
{
    (void)state;
    plumb_world *worlds[2];
    for (int w = 0; w < 2; ++w) {
        worlds[w] = random_world(8, 150, 7, 0.2, 0.8);
        for (int step = 0; step < 120; ++step) {
            assert_int_equal(plumb_world_step(worlds[w], DT), PLUMB_OK);
            plumb_ray_hit hit;
            plumb_nearest_hit near;
            if (w == 1) {
                plumb_world_ray(worlds[w], V(-9, -9), V(9, 9), NULL, &hit);
                plumb_world_nearest(worlds[w], V(0, 0), 1, NULL, &near);
            }
        }
    }
    plumb_body_span a = plumb_world_bodies(worlds[0]), b = plumb_world_bodies(worlds[1]);
    size_t bytes = (size_t)a.count * sizeof(plumb_real);
    assert_int_equal(a.count, b.count);
    assert_memory_equal(a.x, b.x, bytes);
    assert_memory_equal(a.y, b.y, bytes);
    assert_memory_equal(a.c, b.c, bytes);
    assert_memory_equal(a.vx, b.vx, bytes);
    assert_memory_equal(a.w, b.w, bytes);
    plumb_world_destroy(worlds[0]);
    plumb_world_destroy(worlds[1]);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_rays),        cmocka_unit_test(test_rays_mixed_sizes),
        cmocka_unit_test(test_ray_hit),     cmocka_unit_test(test_ray_ties),
        cmocka_unit_test(test_capacity),    cmocka_unit_test(test_filters),
        cmocka_unit_test(test_nested),      cmocka_unit_test(test_changes),
        cmocka_unit_test(test_fast_bodies), cmocka_unit_test(test_motion_is_not_disturbed),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
