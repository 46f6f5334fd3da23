// test_step_changes.c - what rests, rests on however the step is divided: steps from 1 us to 1/10 s in any order.
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "harness/sim.h"

#define HZ60 (1 / 60.0)

typedef struct pile {
    plumb_world *world;
    plumb_body body[40];
    double touching[40]; // [m] where it would stand if nothing gave way
    int count;
} pile;

// Boxes one on another, or a pyramid of them.
static pile make_pile(uint32_t *seed, plumb_solver solver)
{
    pile p = { .world = sim_world(&(plumb_world_desc){ .solver = solver, .no_sleep = true }) };
    const plumb_material m = sim_material(p.world, 0.6, 0);
    sim_floor(p.world, m);
    const int rows = 1 + (int)sim_uniform(seed, 0, 8);
    const int base = sim_uniform(seed, 0, 1) < 0.5 ? 1 : rows;
    const double half = exp(sim_uniform(seed, log(0.1), log(2)));
    for (int i = 0; i < rows; ++i) {
        for (int k = 0; k < (base > 1 ? base - i : 1); ++k, ++p.count) {
            p.touching[p.count] = (2 * i + 1) * half;
            p.body[p.count] = sim_crate(p.world, (2.02 * k + 1.01 * i) * half, p.touching[p.count],
                                        half, half, m);
        }
    }
    return p;
}

// [m] of the highest of them above where it would stand if nothing gave way.
static double highest(const pile *p)
{
    double top = -1;
    for (int i = 0; i < p->count; ++i) {
        top = fmax(top, sim_y(p->world, p->body[i]) - p->touching[i]);
    }
    return top;
}

static double any_step(uint32_t *seed)
{
    return sim_uniform(seed, 0, 1) < 0.3 ? HZ60 : exp(sim_uniform(seed, log(1e-6), log(0.1)));
}

// What a pile has sunk into itself is given back so slowly that nothing rises above where it would stand if nothing
// gave way. Before, the stiffness of its contacts followed the substep at once: piles flew up by 1 to 70 m.
static void piles_do_not_hop(void **state)
{
    (void)state;
    uint32_t seed = 1;
    double worst = -1;
    for (int round = 0; round < 30; ++round) {
        pile p = make_pile(&seed, round % 3 == 2 ? PLUMB_SOLVER_PGS : PLUMB_SOLVER_SOFT);
        sim_run(p.world, 60, HZ60);
        double top = highest(&p);
        for (int i = 0; i < 350; ++i) {
            sim_step(p.world, any_step(&seed));
            top = fmax(top, highest(&p));
        }
        worst = fmax(worst, top);
        assert_true(top < 1e-3);
        plumb_world_destroy(p.world);
    }
    print_message("highest of 10,500 changes: %.2g mm above touching\n", worst * 1e3);
}

// The plain case: all steps shorter from some moment on. In the end contacts are as stiff as the shorter steps bear.
static void a_shorter_step_makes_piles_stiffer(void **state)
{
    (void)state;
    uint32_t seed = 7;
    for (int round = 0; round < 5; ++round) {
        const double shorter = round % 2 == 0 ? 1.0 / 240 : 1.0 / 500;
        pile p = make_pile(&seed, PLUMB_SOLVER_SOFT);
        sim_run(p.world, 240, HZ60);
        const double sunk = p.touching[p.count - 1] - sim_y(p.world, p.body[p.count - 1]);
        for (double t = 0; t < 4; t += shorter) {
            sim_step(p.world, shorter);
            assert_true(highest(&p) < 1e-3);
        }
        const double left = p.touching[p.count - 1] - sim_y(p.world, p.body[p.count - 1]);
        print_message("%2d bodies: %.3f mm, then at %.0f Hz %.3f mm\n", p.count, sunk * 1e3,
                      1 / shorter, left * 1e3);
        assert_true(fabs(left) < sunk / 8);
        plumb_world_destroy(p.world);
    }
}

// A chain that hangs stays where it hangs: what its joints yield is given back as slowly, and long steps behind short
// ones do not throw it about. Before, two links flew to pieces at 1e10 m/s.
static void hanging_chains_stay(void **state)
{
    (void)state;
    uint32_t seed = 3;
    double fastest = 0;
    for (int round = 0; round < 30; ++round) {
        plumb_world *w = sim_world(&(plumb_world_desc){ .no_sleep = true });
        const plumb_material m = sim_material(w, 0.5, 0);
        const int links = 2 + (int)sim_uniform(&seed, 0, 12);
        plumb_body above = { 0 }, link[16];
        for (int i = 0; i < links; ++i) {
            const double kind = sim_uniform(&seed, 0, 3);
            link[i] = sim_crate(w, 0, -0.5 - i, 0.1, 0.5, m);
            plumb_joint_desc d = { .body_a = above, .body_b = link[i], .anchor = sim_vec(0, -i) };
            d.kind = kind < 1 ? PLUMB_REVOLUTE : kind < 2 ? PLUMB_WELD : PLUMB_DISTANCE;
            if (d.kind == PLUMB_DISTANCE) {
                d.anchor = sim_vec(0, 0.1 - i), d.anchor_b = sim_vec(0, -0.1 - i);
            }
            plumb_joint_create(w, &d);
            above = link[i];
        }
        sim_run(w, 240, HZ60);
        for (int i = 0; i < 350; ++i) {
            sim_step(w, any_step(&seed));
            const double rise = sim_y(w, link[links - 1]) - (0.5 - links);
            assert_true(rise < 1e-3);
            assert_true(rise > -0.05 * links);
            assert_true(fabs(sim_x(w, link[links - 1])) < 1e-3);
            fastest = fmax(fastest, fabs(sim_vy(w, link[links - 1])));
        }
        plumb_world_destroy(w);
    }
    print_message("fastest lowest link: %.2g m/s\n", fastest);
    assert_true(fastest < 2);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(piles_do_not_hop),
        cmocka_unit_test(a_shorter_step_makes_piles_stiffer),
        cmocka_unit_test(hanging_chains_stay),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
