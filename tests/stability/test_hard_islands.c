// test_hard_islands.c - islands that sweeps cannot hold are solved exactly, and only those: what stands then, that it
// may be switched off, that nothing else in the world shows in it, that images and rollbacks give the same bits, and that random
// heaps of uneven and overlapping bodies never gain energy.
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "harness/sim.h"

#define HZ60 (1 / 60.0)

static plumb_material heavy_material(plumb_world *w, double density)
{
    return plumb_material_create(
        w, &(plumb_material_desc){ .friction = (plumb_real)0.6, .density = (plumb_real)density });
}

// [m] by which a box sinks into a lighter one that bears it, after two seconds; how many islands were exact.
static double sunk(double ratio, bool off, uint32_t *exact)
{
    plumb_world *w =
        sim_world(&(plumb_world_desc){ .no_exact_islands = off, .no_fine_islands = off });
    plumb_material wood = sim_material(w, 0.6, 0);
    sim_floor(w, wood);
    sim_crate(w, 0, 0.5, 0.5, 0.5, wood);
    plumb_body top = sim_crate(w, 0, 1.5, 0.5, 0.5, heavy_material(w, ratio));
    sim_run(w, 120, HZ60);
    *exact = plumb_world_stats(w).exact_islands;
    const double depth = 1.5 - sim_y(w, top);
    plumb_world_destroy(w);
    return depth;
}

static void heavy_on_light_stands(void **state)
{
    (void)state;
    uint32_t exact;
    for (double ratio = 1; ratio < 2e6; ratio *= 10) {
        const double depth = sunk(ratio, false, &exact);
        print_message("%8g : 1 sinks by %.3g m\n", ratio, depth);
        assert_true(fabs(depth) <= 0.005);
        assert_int_equal(exact, ratio > 10.5);
    }
    assert_true(sunk(1000, true, &exact) > 0.05); // as sweeps have it
    assert_int_equal(exact, 0);
}

// [m] by which a heavy box on a light one moves in the second after it was woken, at any step of a look; it slept, and in
// the step in which it wakes its island is solved exactly.
static double moved_by_waking(double ratio, int steps)
{
    plumb_world *w = sim_world(&(plumb_world_desc){ 0 });
    plumb_material wood = sim_material(w, 0.6, 0);
    sim_floor(w, wood);
    sim_crate(w, 0, 0.5, 0.5, 0.5, wood);
    plumb_body top = sim_crate(w, 0, 1.5, 0.5, 0.5, heavy_material(w, ratio));
    sim_run(w, 240 + steps, HZ60);
    assert_false(plumb_body_is_awake(w, top));
    const double before = sim_y(w, top);
    double most = 0;
    assert_int_equal(plumb_body_wake(w, top), PLUMB_OK);
    for (int i = 0; i < 60; ++i) {
        sim_step(w, HZ60);
        assert_true(i > 20 ||
                    (plumb_body_is_awake(w, top) && plumb_world_stats(w).exact_islands > 0));
        most = fmax(most, fabs(sim_y(w, top) - before));
    }
    plumb_world_destroy(w);
    return most;
}

static void what_wakes_bears_what_it_bore(void **state)
{
    (void)state;
    for (double ratio = 30; ratio < 2e5; ratio *= 10) {
        for (int steps = 0; steps < 9; ++steps) {
            assert_true(moved_by_waking(ratio, steps) < 1e-4);
        }
    }
}

// Stacks as they are in games are left to sweeps; those that sink by hundredths of a crate are not, unless they are so high that a
// direct solution would take milliseconds.
static void only_what_sinks_is_solved_exactly(void **state)
{
    (void)state;
    const int heights[] = { 1, 5, 10, 15, 25, 60 };
    for (size_t k = 0; k < sizeof heights / sizeof heights[0]; ++k) {
        plumb_world *w = sim_world(&(plumb_world_desc){ .no_sleep = true });
        plumb_material wood = sim_material(w, 0.6, 0);
        sim_floor(w, wood);
        plumb_body top = PLUMB_NULL_INIT;
        for (int i = 0; i < heights[k]; ++i) {
            top = sim_crate(w, 0, 0.25 + 0.5 * i, 0.25, 0.25, wood);
        }
        sim_run(w, 300, HZ60);
        assert_int_equal(plumb_world_stats(w).exact_islands, heights[k] == 25);
        assert_true(fabs(sim_y(w, top) + 0.25 - 0.5 * heights[k]) < 0.002 * heights[k]);
        assert_true(sim_max_speed(w) < 1e-3);
        plumb_world_destroy(w);
    }
}

// Towers side by side, each with its foot on the ground. Returns how many have not sunk.
static int add_towers(int towers, int height, double density, plumb_stats *stats)
{
    plumb_body top[200];
    plumb_world *w = sim_world(&(plumb_world_desc){ .no_sleep = true });
    plumb_material light = sim_material(w, 0.6, 0), other = heavy_material(w, density);
    sim_floor(w, light);
    for (int i = 0; i < towers; ++i) {
        for (int k = 0; k < height; ++k) {
            top[i] = sim_crate(w, 2 * i - towers, 0.25 + 0.5 * k, 0.25, 0.25,
                               k % 2 == 1 ? other : light);
        }
    }
    *stats = (plumb_stats){ 0 };
    for (int i = 0; i < 200; ++i) {
        sim_run(w, 1, HZ60);
        const plumb_stats now = plumb_world_stats(w);
        stats->exact_islands =
            now.exact_islands > stats->exact_islands ? now.exact_islands : stats->exact_islands;
        stats->exact_factored =
            now.exact_factored > stats->exact_factored ? now.exact_factored : stats->exact_factored;
    }
    int held = 0;
    for (int i = 0; i < towers; ++i) {
        held += fabs(sim_y(w, top[i]) + 0.25 - 0.5 * height) < 2e-5 * height;
    }
    plumb_world_destroy(w);
    return held;
}

// All islands of a step together have room for so many contacts, however many ask: a frame is not to be missed for what nobody
// asked for. Those that found room keep it, or all would sink by turns.
static void there_is_room_for_few(void **state)
{
    (void)state;
    plumb_stats stats;
    assert_int_equal(add_towers(100, 2, 20, &stats), 24);
    assert_int_equal(stats.exact_islands, 24);
    assert_int_equal(add_towers(20, 2, 20, &stats), 20);
    assert_int_equal(stats.exact_islands, 20);
    assert_int_equal(add_towers(100, 24, 1, &stats), 1);
    assert_int_equal(stats.exact_islands, 1);
    assert_true(stats.exact_factored < 500);
}

// A heap at x of bodies of all sorts: boxes and discs, densities over three decades, some inside others.
static int add_heap(plumb_world *w, double x, uint32_t seed, int count, plumb_body *bodies)
{
    for (int i = 0; i < count; ++i) {
        plumb_material m = heavy_material(w, pow(10, sim_uniform(&seed, 0, 3)));
        const double at = x + sim_uniform(&seed, -0.8, 0.8), y = 0.5 + 0.8 * i;
        const double size = sim_uniform(&seed, 0.15, 0.35);
        bodies[i] = sim_random(&seed) % 2 == 0 ? sim_ball(w, at, y, size, m)
                                               : sim_crate(w, at, y, size, 0.3, m);
    }
    return count;
}

#define HEAP 14

// Bits of a heap are its own: alone, before, behind and between others, and at any width and number of threads.
static void what_else_there_is_does_not_show(void **state)
{
    (void)state;
    for (uint32_t seed = 1; seed <= 6; ++seed) {
        plumb_transform at[4][HEAP];
        for (int variant = 0; variant < 4; ++variant) {
            plumb_world *w = sim_world(&(plumb_world_desc){ .workers = variant == 3 ? 2 : 1,
                                                            .simd_width = variant == 2 ? 4 : 0 });
            sim_floor(w, sim_material(w, 0.6, 0));
            plumb_body heap[HEAP], others[HEAP];
            if (variant == 1 || variant == 3) {
                add_heap(w, -40, seed + 50, HEAP, others);
            }
            add_heap(w, 0, seed, HEAP, heap);
            if (variant >= 2) {
                add_heap(w, 40, seed + 90, HEAP, others);
            }
            sim_run(w, 120, HZ60);
            for (int i = 0; i < HEAP; ++i) {
                at[variant][i] = plumb_body_transform(w, heap[i]);
            }
            plumb_world_destroy(w);
        }
        for (int variant = 1; variant < 4; ++variant) {
            assert_memory_equal(at[0], at[variant], sizeof at[0]);
        }
    }
}

// Which islands are exact is part of the state: a run goes on from its image, bit for bit, wherever it was taken.
static void images_go_on_the_same(void **state)
{
    (void)state;
    for (uint32_t seed = 1; seed <= 4; ++seed) {
        plumb_world *w = sim_world(&(plumb_world_desc){ 0 });
        plumb_world *other = sim_world(&(plumb_world_desc){ 0 });
        sim_floor(w, sim_material(w, 0.6, 0));
        plumb_body heap[HEAP];
        add_heap(w, 0, seed, HEAP, heap);
        uint32_t exact = 0;
        for (int i = 0; i < 120; ++i) {
            const size_t bytes = plumb_world_snapshot_size(w);
            void *image = malloc(bytes);
            assert_non_null(image);
            assert_int_equal(plumb_world_save(w, image, bytes), PLUMB_OK);
            assert_int_equal(plumb_world_restore(other, image, bytes), PLUMB_OK);
            free(image);
            sim_step(w, HZ60);
            sim_step(other, HZ60);
            assert_true(plumb_world_hash(w) == plumb_world_hash(other));
            exact += plumb_world_stats(w).exact_islands;
        }
        assert_true(exact > 0);
        plumb_world_destroy(w);
        plumb_world_destroy(other);
    }
}

// [J] what it may have more of than when it fell: overlaps that were there are undone against gravity.
static void no_heap_gains_energy(void **state)
{
    (void)state;
    uint32_t exact = 0, missed = 0;
    for (uint32_t seed = 1; seed <= 40; ++seed) {
        plumb_world *w = sim_world(&(plumb_world_desc){ 0 });
        sim_floor(w, sim_material(w, 0.6, 0));
        plumb_body heap[HEAP];
        add_heap(w, 0, seed * 77, HEAP, heap);
        const double start = sim_energy(w);
        double most = 0;
        for (int i = 0; i < 180; ++i) {
            sim_step(w, HZ60);
            const double share = sim_energy(w) / start - 1;
            most = share > most ? share : most;
            exact += plumb_world_stats(w).exact_islands;
            missed += plumb_world_stats(w).exact_missed;
        }
        if (most > 0.03) {
            print_message("heap %u: %.3g of its energy more\n", (unsigned)seed, most);
        }
        assert_true(most <= 0.03);
        plumb_world_destroy(w);
    }
    print_message("%u islands exact, %u solutions missed\n", (unsigned)exact, (unsigned)missed);
    assert_true(exact > 1000);
}

// A ball that a joint holds on a heavy box, on a light one: of a joint that nobody watches the force is told all the same,
// and none of what it gave before is held against it when it is to break from now on.
static void joints_tell_what_they_bear(void **state)
{
    (void)state;
    const plumb_joint_kind kinds[] = { PLUMB_REVOLUTE, PLUMB_PRISMATIC, PLUMB_WELD };
    for (size_t i = 0; i < sizeof kinds / sizeof kinds[0]; ++i) {
        plumb_world *w = sim_world(&(plumb_world_desc){ 0 });
        const plumb_material wood = sim_material(w, 0.6, 0), iron = heavy_material(w, 100);
        sim_floor(w, wood);
        const plumb_body light = sim_crate(w, 0, 0.25, 1, 0.25, wood);
        const plumb_body heavy = sim_crate(w, 0, 1, 1, 0.5, iron);
        const plumb_body ball = sim_ball(w, 0, 2, 0.3, iron);
        const plumb_joint j = plumb_joint_create(
            w, &(plumb_joint_desc){
                   .kind = kinds[i], .body_a = heavy, .body_b = ball, .anchor = { 0, 1 } });
        plumb_joint_create(
            w, &(plumb_joint_desc){ .body_b = light, .tell_impulse = true, .disabled = true });
        sim_run(w, 60, HZ60);
        assert_true(plumb_world_stats(w).exact_islands > 0);
        const double weight = SIM_G * (double)plumb_body_mass(w, ball);
        const double force = (double)plumb_vec2_magnitude(plumb_joint_force(w, j));
        print_message("%s: %.4g N of %.4g N\n", plumb_joint_kind_name(kinds[i]), force, weight);
        assert_true(fabs(force - weight) < 0.01 * weight);
        plumb_joint_set_break(w, j, (plumb_real)(2 * weight), 0);
        sim_run(w, 1, HZ60);
        assert_true(plumb_joint_valid(w, j));
        plumb_world_destroy(w);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(heavy_on_light_stands),
        cmocka_unit_test(what_wakes_bears_what_it_bore),
        cmocka_unit_test(only_what_sinks_is_solved_exactly),
        cmocka_unit_test(there_is_room_for_few),
        cmocka_unit_test(what_else_there_is_does_not_show),
        cmocka_unit_test(images_go_on_the_same),
        cmocka_unit_test(no_heap_gains_energy),
        cmocka_unit_test(joints_tell_what_they_bear),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
