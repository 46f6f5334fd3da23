// test_pushed_sleep.c - bodies at rest under steady forces fall asleep, whoever pushes them; forces that
// change, creep or end wake them within a step. Stacks, forces and steps are drawn by a seed.
#include "harness/random.h"
#include "plumb/plumb.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <cmocka.h>

#define R(x)   ((plumb_real)(x))
#define MOST   40
#define LIMIT  0.008 // [m/s^2] by default: 4 * 0.02 * sleep_speed / sleep_time
#define WEIGHT 9.81

typedef enum pusher {
    CALLS,        // between steps
    CALLS_WITHIN, // the same calls, from a system
    AWAKE_ROWS,   // a system that leaves sleeping rows alone
    ALL_ROWS,
    VIEW,
    PUSHERS
} pusher;

typedef struct pile {
    plumb_world *world;
    plumb_body body[MOST];
    plumb_vec2 force[MOST]; // [N] of now
    plumb_real torque[MOST];
    int count;
    pusher by;
    plumb_component component;
    plumb_real dt;
    int slept; // events since it was made
} pile;

typedef struct push {
    plumb_real fx, fy, torque;
} push;

static push push_of(const pile *p, plumb_body body)
{
    for (int i = 0; i < p->count; ++i) {
        if (plumb_same(p->body[i], body)) {
            return (push){ p->force[i].x, p->force[i].y, p->torque[i] };
        }
    }
    return (push){ 0, 0, 0 };
}

static void push_rows(const pile *p, int first, int end)
{
    plumb_body_span b = plumb_world_bodies(p->world);
    for (int row = first; row < end; ++row) {
        const push f = push_of(p, b.body[row]);
        b.fx[row] += f.fx;
        b.fy[row] += f.fy;
        b.torque[row] += f.torque;
    }
}

static void push_view(const pile *p)
{
    plumb_body_span b = plumb_world_bodies(p->world);
    plumb_body_view view;
    plumb_body_view_open(
        p->world, &(plumb_body_view_desc){ .with = { p->component }, .rows = PLUMB_VIEW_DYNAMIC },
        &view);
    while (plumb_body_view_next(&view)) {
        const push *f = view.values[0];
        for (int i = 0; i < view.count; ++i) {
            b.fx[view.row + i] += f[i].fx;
            b.fy[view.row + i] += f[i].fy;
            b.torque[view.row + i] += f[i].torque;
        }
    }
}

// In two parts: what counts is their sum.
static void push_by_calls(const pile *p)
{
    for (int i = 0; i < p->count; ++i) {
        const plumb_vec2 half = plumb_v2(p->force[i].x / 2, p->force[i].y / 2);
        plumb_body_apply_force_center(p->world, p->body[i], half);
        plumb_body_apply_force_center(p->world, p->body[i], half);
        plumb_body_apply_torque(p->world, p->body[i], p->torque[i]);
    }
}

static void run_pusher(const plumb_system_call *call)
{
    const pile *p = call->context;
    const plumb_body_span b = plumb_world_bodies(p->world);
    switch (p->by) {
    case CALLS_WITHIN:
        push_by_calls(p);
        break;
    case AWAKE_ROWS:
        push_rows(p, 0, b.dynamic_count);
        break;
    case ALL_ROWS:
        push_rows(p, 0, b.count - b.static_count - b.disabled_count);
        break;
    case VIEW:
        push_view(p);
        break;
    default:
        break;
    }
}

static void set_values(pile *p)
{
    for (int i = 0; i < p->count && p->by == VIEW; ++i) {
        const push f = push_of(p, p->body[i]);
        plumb_component_set(p->world, p->body[i].entity, p->component, &f);
    }
}

static void step(pile *p)
{
    int slept;
    if (p->by == CALLS) {
        push_by_calls(p);
    }
    set_values(p);
    assert_int_equal(plumb_world_step(p->world, p->dt), PLUMB_OK);
    plumb_world_sleep_events(p->world, &slept);
    p->slept += slept;
}

static void add_stack(pile *p, uint32_t *seed, double x)
{
    const int height = 1 + (int)sim_uniform(seed, 0, 4);
    double y = 0, half = sim_uniform(seed, 0.3, 0.8);
    for (int i = 0; i < height && p->count < MOST; ++i) {
        const plumb_body b =
            plumb_body_create(p->world, &(plumb_body_desc){ .position = { R(x), R(y + half) } });
        plumb_shape_create(p->world, b,
                           &(plumb_shape_desc){ .kind = PLUMB_BOX, .half = { R(half), R(half) } });
        const double m = (double)plumb_body_mass(p->world, b);
        const double f = sim_uniform(seed, 0.002, 0.06) * m * WEIGHT; // friction is 0.6
        const double angle = sim_uniform(seed, 0, 6.28);
        p->force[p->count] = plumb_v2(R(f * cos(angle)), R(f * sin(angle)));
        p->torque[p->count] = R(sim_uniform(seed, -0.02, 0.02) * m * WEIGHT * half);
        p->body[p->count++] = b;
        y += 2 * half;
        half *= sim_uniform(seed, 0.7, 1);
    }
}

// The world keeps a pointer to the pile.
static void make(pile *p, uint32_t seed, pusher by)
{
    static const double steps[] = { 1.0 / 30, 1.0 / 60, 1.0 / 144 };
    uint32_t state = seed * 2654435761u + 1;
    *p = (pile){ .by = by, .dt = R(steps[seed % 3]) };
    const plumb_world_desc desc = { .solver =
                                        seed % 2 == 0 ? PLUMB_SOLVER_SOFT : PLUMB_SOLVER_PGS };
    assert_int_equal(plumb_world_create(&desc, &p->world), PLUMB_OK);
    const plumb_body ground = plumb_body_create(
        p->world, &(plumb_body_desc){ .type = PLUMB_STATIC, .position = { 0, -1 } });
    plumb_shape_create(p->world, ground,
                       &(plumb_shape_desc){ .kind = PLUMB_BOX, .half = { 100, 1 } });
    p->component = plumb_component_create(
        p->world, &(plumb_component_desc){ .name = "push", .size = sizeof(push) });
    for (int i = 0; i < 8; ++i) {
        add_stack(p, &state, 3 * i);
    }
    if (by != CALLS) {
        plumb_system_create(p->world, &(plumb_system_desc){ .name = "push",
                                                            .phase = PLUMB_PHASE_FORCES,
                                                            .run = run_pusher,
                                                            .context = p });
    }
}

static int asleep(const pile *p)
{
    return (int)plumb_world_stats(p->world).asleep_count;
}

static void run_until_asleep(pile *p, double seconds)
{
    for (double t = 0; t < seconds && asleep(p) < p->count; t += (double)p->dt) {
        step(p);
    }
}

// For good: whom nobody tells in its sleep wakes once to ask.
static void settle(pile *p)
{
    run_until_asleep(p, 20);
    for (double t = 0; t < 2 && p->by == AWAKE_ROWS; t += (double)p->dt) {
        step(p);
    }
}

static void who_rests_under_a_steady_force_sleeps_and_stays(void **state)
{
    (void)state;
    for (uint32_t seed = 1; seed <= 12; ++seed) {
        for (int by = 0; by < PUSHERS; ++by) {
            pile p;
            plumb_vec2 at[MOST];
            make(&p, seed, (pusher)by);
            settle(&p);
            if (asleep(&p) < p.count) {
                fail_msg("seed %u, pusher %d: %d of %d asleep after 20 s", seed, by, asleep(&p),
                         p.count);
            }
            for (int i = 0; i < p.count; ++i) {
                at[i] = plumb_body_position(p.world, p.body[i]);
            }
            const int slept = p.slept;
            for (int i = 0; i < 300; ++i) {
                step(&p);
            }
            assert_int_equal(p.slept, slept); // and nobody woke meanwhile
            assert_int_equal(asleep(&p), p.count);
            for (int i = 0; i < p.count; ++i) {
                const plumb_vec2 now = plumb_body_position(p.world, p.body[i]);
                assert_true(now.x == at[i].x && now.y == at[i].y);
            }
            plumb_world_destroy(p.world);
        }
    }
}

// Whether a body is awake after a step under another force; everything is as before afterwards.
static bool wakes(pile *p, int i, double dfx, double dtorque)
{
    static char image[1 << 20];
    const size_t size = plumb_world_snapshot_size(p->world);
    const plumb_vec2 force = p->force[i];
    const plumb_real torque = p->torque[i];
    assert_true(size <= sizeof image);
    assert_int_equal(plumb_world_save(p->world, image, size), PLUMB_OK);
    p->force[i].x += R(dfx);
    p->torque[i] += R(dtorque);
    step(p);
    const bool awake = plumb_body_is_awake(p->world, p->body[i]);
    p->force[i] = force;
    p->torque[i] = torque;
    assert_int_equal(plumb_world_restore(p->world, image, size), PLUMB_OK);
    return awake;
}

static void a_change_beyond_the_tolerance_wakes_within_a_step(void **state)
{
    (void)state;
    for (uint32_t seed = 1; seed <= 6; ++seed) {
        for (int by = 0; by < PUSHERS; ++by) {
            pile p;
            if (by == AWAKE_ROWS) {
                continue; // it tells sleeping rows nothing
            }
            make(&p, seed, (pusher)by);
            settle(&p);
            for (int k = 0; k < 5; ++k) {
                step(&p); // to compare with what is told asleep, not as it fell asleep
            }
            assert_int_equal(asleep(&p), p.count);
            for (int i = 0; i < p.count; ++i) {
                const double m = (double)plumb_body_mass(p.world, p.body[i]);
                const double inertia = (double)plumb_body_inertia(p.world, p.body[i]);
                const plumb_aabb box = plumb_body_aabb(p.world, p.body[i]);
                const double half = (double)(box.max.x - box.min.x) / 2;
                const double arm = inertia / (half * 1.41421356); // of the farthest corner
                assert_false(wakes(&p, i, 0, 0));
                assert_false(wakes(&p, i, 0.9 * LIMIT * m, 0));
                assert_true(wakes(&p, i, 1.1 * LIMIT * m, 0));
                assert_true(wakes(&p, i, -1.1 * LIMIT * m, 0));
                assert_false(wakes(&p, i, 0, 0.9 * LIMIT * arm));
                assert_true(wakes(&p, i, 0, 1.1 * LIMIT * arm));
                assert_true(wakes(&p, i, -(double)p.force[i].x, -(double)p.torque[i]) ||
                            fabs((double)p.force[i].x) < 1.1 * LIMIT * m);
            }
            plumb_world_destroy(p.world);
        }
    }
}

static void a_force_that_creeps_wakes_when_it_has_come_far_enough(void **state)
{
    (void)state;
    for (int by = 0; by < PUSHERS; ++by) {
        pile p;
        if (by == AWAKE_ROWS) {
            continue;
        }
        make(&p, 5, (pusher)by);
        settle(&p);
        step(&p);
        const double m = (double)plumb_body_mass(p.world, p.body[0]);
        int steps = 0;
        for (; !plumb_body_is_awake(p.world, p.body[0]) && steps < 1000; ++steps) {
            p.force[0].x += R(LIMIT * m / 100);
            step(&p);
        }
        assert_in_range(steps, 98, 103);
        plumb_world_destroy(p.world);
    }
}

static void a_force_that_ends_wakes_within_a_step(void **state)
{
    (void)state;
    for (uint32_t seed = 1; seed <= 6; ++seed) {
        for (int by = 0; by < PUSHERS; ++by) {
            pile p;
            make(&p, seed, (pusher)by);
            for (int k = 0; k < 4; ++k) { // in each of the first steps of its sleep
                settle(&p);
                for (int i = 0; i < k; ++i) {
                    step(&p);
                }
                assert_int_equal(asleep(&p), p.count);
                const plumb_vec2 kept[] = { p.force[0], p.force[1], p.force[2] };
                for (int i = 0; i < 3; ++i) {
                    p.force[i] = plumb_v2(0, 0);
                    p.torque[i] = 0;
                }
                if (by ==
                    AWAKE_ROWS) { // nobody tells what sleeps: the system itself is switched off
                    plumb_system_enable(p.world, "push", false);
                }
                step(&p);
                for (int i = 0; i < 3; ++i) {
                    assert_true(plumb_body_is_awake(p.world, p.body[i]));
                    p.force[i] = kept[i];
                }
                if (by == AWAKE_ROWS) {
                    plumb_system_enable(p.world, "push", true);
                }
            }
            plumb_world_destroy(p.world);
        }
    }
}

// Held against a ceiling by a force alone: it hangs in its sleep, and falls when the force ends.
static void who_hangs_by_a_force_falls_when_it_ends(void **state)
{
    (void)state;
    for (int by = 0; by < PUSHERS; ++by) {
        pile p;
        make(&p, 1, (pusher)by);
        const plumb_body roof = plumb_body_create(
            p.world, &(plumb_body_desc){ .type = PLUMB_STATIC, .position = { -9, 11 } });
        plumb_shape_create(p.world, roof,
                           &(plumb_shape_desc){ .kind = PLUMB_BOX, .half = { 2, 1 } });
        const plumb_body b =
            plumb_body_create(p.world, &(plumb_body_desc){ .position = { -9, R(9.5) } });
        plumb_shape_create(p.world, b,
                           &(plumb_shape_desc){ .kind = PLUMB_BOX, .half = { R(0.5), R(0.5) } });
        const int i = p.count++;
        p.body[i] = b;
        p.force[i] = plumb_v2(0, R(1.5 * WEIGHT) * plumb_body_mass(p.world, b));
        p.torque[i] = 0;
        settle(&p);
        assert_int_equal(asleep(&p), p.count);
        for (int k = 0; k < 20; ++k) {
            step(&p);
        }
        assert_int_equal(asleep(&p), p.count);
        assert_true(plumb_body_position(p.world, b).y > R(9.4));
        p.force[i] = plumb_v2(0, 0);
        if (by == AWAKE_ROWS) {
            plumb_system_enable(p.world, "push", false);
        }
        for (double t = 0; t < 2; t += (double)p.dt) {
            step(&p);
        }
        assert_true(plumb_body_position(p.world, b).y < 1);
        plumb_world_destroy(p.world);
    }
}

// A force that begins under a body that is about to fall asleep: it has to be seen to do nothing first.
static void a_force_that_begins_is_felt_at_any_moment(void **state)
{
    (void)state;
    for (int wait = 0; wait < 120; ++wait) {
        pile p;
        make(&p, 2, ALL_ROWS);
        for (int i = 0; i < p.count; ++i) {
            p.force[i] = plumb_v2(0, 0);
            p.torque[i] = 0;
        }
        for (int i = 0; i < wait; ++i) {
            step(&p);
        }
        const plumb_real before = plumb_body_position(p.world, p.body[0]).x;
        const plumb_real pushed = R(10 * WEIGHT) * plumb_body_mass(p.world, p.body[0]);
        p.force[0] = plumb_v2(-pushed, 0);
        for (int i = 0; i < 10; ++i) {
            step(&p);
        }
        assert_true(plumb_body_position(p.world, p.body[0]).x < before - R(0.005));
        plumb_world_destroy(p.world);
    }
}

// From any step, the same bits again: what a body sleeps under is state.
static void a_restored_world_sleeps_and_wakes_as_the_other(void **state)
{
    (void)state;
    static char image[1 << 20];
    for (int by = 0; by < PUSHERS; ++by) {
        uint64_t hashes[60];
        pile p;
        make(&p, 3, (pusher)by);
        settle(&p);
        for (int from = 0; from < 12; ++from) {
            const size_t size = plumb_world_snapshot_size(p.world);
            assert_int_equal(plumb_world_save(p.world, image, size), PLUMB_OK);
            for (int again = 0; again < 2; ++again) {
                const plumb_vec2 force = p.force[0];
                for (int i = 0; i < 60; ++i) {
                    p.force[0] = i >= 20 && i < 40 ? plumb_v2(1, 0) : force;
                    step(&p);
                    const uint64_t hash = plumb_world_hash(p.world);
                    assert_true(again == 0 || hash == hashes[i]);
                    hashes[i] = hash;
                }
                p.force[0] = force;
                if (again == 0) {
                    assert_int_equal(plumb_world_restore(p.world, image, size), PLUMB_OK);
                }
            }
        }
        plumb_world_destroy(p.world);
    }
}

// Drag of a user's, over the rows that sleep too: who is set still has another force, and sleeps on.
static plumb_real rate;

static void drag(const plumb_system_call *call)
{
    plumb_body_span b = plumb_world_bodies(call->world);
    const plumb_real wind = call->context != NULL ? R(0.2) : 0;
    for (int row = 0; row < b.count - b.static_count - b.disabled_count; ++row) {
        const plumb_real m = b.inv_mass[row] > 0 ? 1 / b.inv_mass[row] : 0;
        b.fx[row] += m * rate * (wind - b.vx[row]);
        b.fy[row] -= m * rate * b.vy[row];
    }
}

static void who_is_braked_by_a_system_sleeps(void **state)
{
    (void)state;
    for (uint32_t seed = 1; seed <= 6; ++seed) {
        for (int windy = 0; windy < 2; ++windy) {
            for (rate = R(0.1); rate < 30; rate *= 3) {
                pile p;
                make(&p, seed, CALLS);
                for (int i = 0; i < p.count; ++i) {
                    p.force[i] = plumb_v2(0, 0);
                    p.torque[i] = 0;
                }
                plumb_system_create(p.world, &(plumb_system_desc){ .name = "drag",
                                                                   .phase = PLUMB_PHASE_FORCES,
                                                                   .run = drag,
                                                                   .context = windy ? &p : NULL });
                settle(&p);
                if (windy && rate > 10) { // strong enough to move some
                    plumb_world_destroy(p.world);
                    continue;
                }
                assert_int_equal(asleep(&p), p.count);
                const int slept = p.slept;
                for (int i = 0; i < 120; ++i) {
                    step(&p);
                }
                if (p.slept != slept || asleep(&p) != p.count) {
                    fail_msg("seed %u, rate %g, windy %d: %d fell asleep again", seed, (double)rate,
                             windy, p.slept - slept);
                }
                plumb_world_destroy(p.world);
            }
        }
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(who_rests_under_a_steady_force_sleeps_and_stays),
        cmocka_unit_test(a_change_beyond_the_tolerance_wakes_within_a_step),
        cmocka_unit_test(a_force_that_creeps_wakes_when_it_has_come_far_enough),
        cmocka_unit_test(a_force_that_ends_wakes_within_a_step),
        cmocka_unit_test(who_hangs_by_a_force_falls_when_it_ends),
        cmocka_unit_test(a_force_that_begins_is_felt_at_any_moment),
        cmocka_unit_test(a_restored_world_sleeps_and_wakes_as_the_other),
        cmocka_unit_test(who_is_braked_by_a_system_sleeps),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
