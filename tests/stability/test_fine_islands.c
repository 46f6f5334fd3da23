// test_fine_islands.c - in a small world bodies that touch one another take finer substeps (solver/apart.c): which, what holds
// then, that nothing hops where islands become fine and stop to be, and that what is told of them is told as of others.
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

#include "harness/sim.h"

#define HZ60 (1 / 60.0)

static uint32_t fine_of(const plumb_world_desc *desc, double restitution, int stacks, int height)
{
    plumb_world *w = sim_world(desc);
    plumb_material m = sim_material(w, 0.6, restitution);
    sim_floor(w, m);
    for (int i = 0; i < stacks; ++i) {
        for (int k = 0; k < height; ++k) {
            sim_crate(w, 1.5 * (i - stacks / 2), 0.5 + k, 0.5, 0.5, m);
        }
    }
    sim_run(w, 20, HZ60);
    const uint32_t fine = plumb_world_stats(w).fine_islands;
    plumb_world_destroy(w);
    return fine;
}

static void which_islands_are_fine(void **state)
{
    (void)state;
    const plumb_world_desc plain = { .no_sleep = true };
    assert_int_equal(fine_of(&plain, 0, 3, 1), 0); // they touch the ground alone
    assert_int_equal(fine_of(&plain, 0, 1, 2), 1);
    assert_int_equal(fine_of(&plain, 0, 20, 4), 20); // 80 contacts
    assert_int_equal(fine_of(&plain, 0, 50, 10), 50);
    assert_int_equal(fine_of(&plain, 0, 60, 10), 0); // the world is not small
    assert_int_equal(fine_of(&plain, 0.1, 1, 2), 1);
    assert_int_equal(fine_of(&plain, 0.5, 1, 2), 0); // impacts are events
    assert_int_equal(
        fine_of(&(plumb_world_desc){ .no_sleep = true, .no_fine_islands = true }, 0, 1, 2), 0);
    assert_int_equal(
        fine_of(&(plumb_world_desc){ .no_sleep = true, .solver = PLUMB_SOLVER_PGS }, 0, 1, 2), 0);
    assert_int_equal(
        fine_of(&(plumb_world_desc){ .no_sleep = true, .solver = PLUMB_SOLVER_EXACT }, 0, 1, 2), 0);
    assert_int_equal(fine_of(&(plumb_world_desc){ .no_sleep = true, .substeps = 1 }, 0, 1, 2), 1);
    assert_int_equal(fine_of(&(plumb_world_desc){ .no_sleep = true, .substeps = 32 }, 0, 1, 2), 1);
}

static void count_call(const plumb_system_call *call)
{
    ++*(int *)call->context;
}

// A system that runs in substeps is called as often as the world has them.
static void systems_of_substeps_count_them(void **state)
{
    (void)state;
    int calls = 0;
    plumb_world *w = sim_world(&(plumb_world_desc){ .no_sleep = true });
    plumb_material m = sim_material(w, 0.6, 0);
    sim_floor(w, m);
    sim_crate(w, 0, 0.5, 0.5, 0.5, m);
    sim_crate(w, 0, 1.5, 0.5, 0.5, m);
    assert_int_equal(plumb_system_create(w, &(plumb_system_desc){ .name = "count",
                                                                  .phase = PLUMB_PHASE_SUBSTEP,
                                                                  .run = count_call,
                                                                  .context = &calls }),
                     PLUMB_OK);
    sim_run(w, 10, HZ60);
    assert_int_equal(calls, 40);
    assert_int_equal(plumb_world_stats(w).fine_islands, 0);
    plumb_world_destroy(w);
}

#define HEIGHT 10
#define CROWD  600

static plumb_body add_stack(plumb_world *w, plumb_material m, plumb_body *bodies)
{
    plumb_body floor = sim_floor(w, m);
    for (int i = 0; i < HEIGHT; ++i) {
        bodies[i] = sim_crate(w, 0, 0.5 + i, 0.5, 0.5, m);
    }
    return floor;
}

// A crowd comes and goes by chance, so that the stack is fine, then not, in steps of all lengths: it sinks and rises, and
// nothing throws it up, or above where it would stand if nothing gave way.
static void nothing_hops_where_islands_change(void **state)
{
    (void)state;
    for (uint32_t seed = 1; seed <= 3; ++seed) {
        uint32_t draw = seed;
        plumb_world *w = sim_world(&(plumb_world_desc){ .no_sleep = true });
        plumb_material m = sim_material(w, 0.6, 0);
        plumb_body stack[HEIGHT], crowd[CROWD];
        add_stack(w, m, stack);
        bool crowded = false;
        int changes = 0;
        uint32_t fine = 0, coarse = 0;
        for (int i = 0; i < 900; ++i) {
            if (sim_random(&draw) % 40 == 0) {
                ++changes;
                crowded = !crowded;
                for (int k = 0; k < CROWD; ++k) {
                    if (crowded) {
                        crowd[k] =
                            sim_crate(w, 5 + 0.5 * (k / 2), 0.1 + 0.2 * (k % 2), 0.1, 0.1, m);
                    } else {
                        plumb_body_destroy(w, crowd[k]);
                    }
                }
            }
            const double before = sim_y(w, stack[HEIGHT - 1]);
            const double dt = changes % 4 == 3 ? HZ60 * sim_uniform(&draw, 0.25, 1) : HZ60;
            sim_step(w, dt);
            const double top = sim_y(w, stack[HEIGHT - 1]);
            fine += plumb_world_stats(w).fine_islands == 1;
            coarse += plumb_world_stats(w).fine_islands == 0;
            assert_true(top < HEIGHT - 0.5 + 1e-4 && top > HEIGHT - 0.5 - 0.03);
            assert_true((top - before) / dt < 0.1);
            assert_true(fabs(sim_x(w, stack[HEIGHT - 1])) < 1e-3);
        }
        print_message("%d changes, %u steps fine, %u not\n", changes, (unsigned)fine,
                      (unsigned)coarse);
        assert_true(changes > 10 && fine > 100 && coarse > 100);
        plumb_world_destroy(w);
    }
}

// Impulses are told as of any other island: forces of a stack are the weights on them.
static void forces_are_weights(void **state)
{
    (void)state;
    plumb_world *w = sim_world(&(plumb_world_desc){ .no_sleep = true, .contact_impulses = true });
    plumb_material m = sim_material(w, 0.6, 0);
    plumb_body stack[HEIGHT];
    plumb_body below = add_stack(w, m, stack);
    sim_run(w, 240, HZ60);
    assert_int_equal(plumb_world_stats(w).fine_islands, 1);
    for (int i = 0; i < HEIGHT; ++i) {
        const double weight = (HEIGHT - i) * (double)plumb_body_mass(w, stack[i]) * 9.81;
        const double force = sim_normal_force(w, below, stack[i], HZ60);
        assert_true(fabs(force / weight - 1) < 1e-3);
        below = stack[i];
    }
    plumb_world_destroy(w);
}

// What acts in substeps acts in as many as there are: damping of two discs that fly side by side, in touch.
static void damping_is_what_it_says(void **state)
{
    (void)state;
    plumb_world *w = sim_space();
    plumb_material m = sim_material(w, 0, 0);
    plumb_body pair[2] = { sim_ball(w, 0, 0, 0.5, m), sim_ball(w, 0, 1, 0.5, m) };
    for (int i = 0; i < 2; ++i) {
        plumb_body_set_damping(w, pair[i], 2, 0);
        sim_launch(w, pair[i], 10, 0, 0);
    }
    sim_run(w, 60, HZ60);
    assert_int_equal(plumb_world_stats(w).fine_islands, 1);
    for (int i = 0; i < 2; ++i) {
        assert_true(fabs(sim_vx(w, pair[i]) - 10 * exp(-2)) < 1e-5);
        assert_true(fabs(sim_x(w, pair[i]) - 5 * (1 - exp(-2))) < 1e-4);
    }
    plumb_world_destroy(w);
}

// Books that overhang by 0.9 of what theory allows stand; swept as others are, they fall.
static void books_stand(void **state)
{
    (void)state;
    for (int off = 0; off < 2; ++off) {
        plumb_world *w = sim_world(&(plumb_world_desc){ .no_sleep = true, .no_fine_islands = off });
        plumb_material m = sim_material(w, 0.6, 0);
        plumb_body top = sim_body(w, PLUMB_STATIC, 0, -0.5, 0);
        sim_add_box(w, top, 1, 0.5, m);
        double edge = 1; // of what is below
        for (int i = 0; i < 10; ++i) {
            edge += 0.9 * 0.5 / (10 - i);
            top = sim_crate(w, edge - 0.5, 0.1 + 0.2 * i, 0.5, 0.1, m);
        }
        sim_run(w, 300, HZ60);
        assert_true((sim_y(w, top) > 1.8) == (off == 0));
        plumb_world_destroy(w);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(which_islands_are_fine),
        cmocka_unit_test(systems_of_substeps_count_them),
        cmocka_unit_test(nothing_hops_where_islands_change),
        cmocka_unit_test(forces_are_weights),
        cmocka_unit_test(damping_is_what_it_says),
        cmocka_unit_test(books_stand),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
