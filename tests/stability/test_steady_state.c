// test_steady_state.c - busy worlds at work, with an allocator that counts: steps that the
// tables have room for allocate nothing, whatever comes, goes, sleeps and wakes. The same steps are taken
// twice, from a snapshot: the second time there has been a need for all that they need.
#include "harness/heap.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#define R(x) ((plumb_real)(x))
#define DT   ((plumb_real)(1.0 / 60))

typedef struct busy {
    plumb_world *world;
    plumb_random dice;
    plumb_body bodies[128];
    int count;
} busy;

static busy begin(plumb_world_desc desc)
{
    static heap memory;
    memory = (heap)HEAP_INIT;
    busy b = { .dice = plumb_random_stream(3, 0) };
    desc.allocator = heap_allocator(&memory);
    assert_int_equal(plumb_world_create(&desc, &b.world), PLUMB_OK);
    return b;
}

static long asked(const busy *b)
{
    return ((const heap *)plumb_world_settings(b->world).allocator.context)->calls;
}

static void wall(const busy *b, plumb_body body, double x, double y, double half_x, double half_y)
{
    const plumb_shape_desc box = { .kind = PLUMB_BOX,
                                   .half = { R(half_x), R(half_y) },
                                   .center = { R(x), R(y) } };
    assert_false(plumb_is_null(plumb_shape_create(b->world, body, &box)));
}

// A room of four walls about a body.
static plumb_body room(const busy *b, plumb_body_type type, double spin)
{
    plumb_body body = plumb_body_create(
        b->world, &(plumb_body_desc){ .type = type, .angular_velocity = R(spin) });
    wall(b, body, 0, -6, 6.5, 0.5);
    wall(b, body, 0, 6, 6.5, 0.5);
    wall(b, body, -6, 0, 0.5, 6.5);
    wall(b, body, 6, 0, 0.5, 6.5);
    return body;
}

static plumb_body drop(busy *b, int kind)
{
    const plumb_vec2 at = { plumb_random_range(&b->dice, -4, 4),
                            plumb_random_range(&b->dice, -4, 4) };
    const plumb_shape_desc shapes[] = {
        { .kind = PLUMB_CIRCLE, .radius = R(0.3) },
        { .kind = PLUMB_BOX, .half = { R(0.3), R(0.2) } },
        { .kind = PLUMB_BOX, .half = { R(0.35), R(0.1) }, .radius = R(0.05) },
    };
    plumb_shape_desc shape = shapes[kind % 3];
    plumb_body body = plumb_body_create(b->world, &(plumb_body_desc){ .position = at });
    assert_false(plumb_is_null(plumb_shape_create(b->world, body, &shape)));
    return body;
}

static void fill(busy *b, int count)
{
    for (b->count = 0; b->count < count; ++b->count) {
        b->bodies[b->count] = drop(b, b->count);
    }
}

typedef void before_fn(busy *b, int step);

// Takes steps; returns how often they asked for memory.
static long take(busy *b, before_fn *before, int steps)
{
    long in_steps = 0;
    for (int i = 0; i < steps; ++i) {
        if (before != NULL) {
            before(b, i);
        }
        long calls = asked(b);
        assert_int_equal(plumb_world_step(b->world, DT), PLUMB_OK);
        in_steps += asked(b) - calls;
    }
    return in_steps;
}

static void expect_steady(busy *b, before_fn *before, int steps)
{
    take(b, before, 120); // in motion
    busy then = *b;
    size_t size = plumb_world_snapshot_size(b->world);
    void *image = malloc(size);
    assert_int_equal(plumb_world_save(b->world, image, size), PLUMB_OK);
    assert_true(take(b, before, steps) > 0); // it is not for want of work
    uint64_t end = plumb_world_hash(b->world);
    *b = then;
    assert_int_equal(plumb_world_restore(b->world, image, size), PLUMB_OK);
    assert_int_equal(take(b, before, steps), 0);
    assert_true(plumb_world_hash(b->world) == end);
    free(image);
    plumb_world_destroy(b->world);
}

static void a_tumbler(void **state)
{
    (void)state;
    busy b = begin((plumb_world_desc){ .hit_speed = 1 });
    room(&b, PLUMB_KINEMATIC, 0.6);
    fill(&b, 100);
    expect_steady(&b, NULL, 1500);
}

// Bodies come and go, in the same number: rows, handles and contacts are used again.
static void replace_one(busy *b, int step)
{
    int i = step % b->count;
    assert_int_equal(plumb_body_destroy(b->world, b->bodies[i]), PLUMB_OK);
    b->bodies[i] = drop(b, i);
}

static void coming_and_going(void **state)
{
    (void)state;
    busy b = begin((plumb_world_desc){ .contact_impulses = true });
    room(&b, PLUMB_STATIC, 0);
    fill(&b, 60);
    expect_steady(&b, replace_one, 1500);
}

// All fall asleep, and are woken by a blast, every four seconds.
static void blow_now_and_then(busy *b, int step)
{
    const plumb_explosion_desc blast = { .position = { 0, -5 }, .radius = 8, .impulse = 2 };
    if (step % 240 == 239) {
        assert_int_equal(plumb_world_explode(b->world, &blast), PLUMB_OK);
    }
}

static void sleeping_and_waking(void **state)
{
    (void)state;
    busy b = begin((plumb_world_desc){ .sleep_time = R(0.2) });
    room(&b, PLUMB_STATIC, 0);
    fill(&b, 60);
    expect_steady(&b, blow_now_and_then, 1500);
}

// Chains in a drum: limits, motors, and contacts of what they tie.
static void joints_in_a_drum(void **state)
{
    (void)state;
    busy b = begin((plumb_world_desc){ .no_sleep = true });
    room(&b, PLUMB_KINEMATIC, 0.5);
    for (int chain = 0; chain < 8; ++chain) {
        plumb_body last = PLUMB_NULL_INIT;
        for (int i = 0; i < 6; ++i) {
            const plumb_vec2 at = { R(0.7 * i - 2), R(1.1 * chain - 4) };
            plumb_body link = plumb_body_create(b.world, &(plumb_body_desc){ .position = at });
            const plumb_shape_desc box = { .kind = PLUMB_BOX, .half = { R(0.35), R(0.1) } };
            plumb_shape_create(b.world, link, &box);
            const plumb_joint_desc hinge = { .kind = PLUMB_REVOLUTE,
                                             .body_a = last,
                                             .body_b = link,
                                             .anchor = { at.x - R(0.35), at.y } };
            assert_true(i == 0 || !plumb_is_null(plumb_joint_create(b.world, &hinge)));
            last = b.bodies[b.count++] = link;
        }
    }
    expect_steady(&b, NULL, 1500);
}

// Hints: with room reserved for bodies and shapes, making them asks for no more of it.
static void capacity_is_reserved_ahead(void **state)
{
    (void)state;
    long calls[2];
    for (int hinted = 0; hinted < 2; ++hinted) {
        plumb_world_desc d = { .no_sleep = true };
        if (hinted == 1) {
            d.body_capacity = d.shape_capacity = 128;
            d.contact_capacity = 1024;
        }
        busy b = begin(d);
        room(&b, PLUMB_STATIC, 0);
        fill(&b, 1);
        long before = asked(&b);
        fill(&b, 100);
        calls[hinted] = asked(&b) - before;
        plumb_world_destroy(b.world);
    }
    assert_true(calls[0] > 5);
    assert_int_equal(calls[1], 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_tumbler),
        cmocka_unit_test(coming_and_going),
        cmocka_unit_test(sleeping_and_waking),
        cmocka_unit_test(joints_in_a_drum),
        cmocka_unit_test(capacity_is_reserved_ahead),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
