// test_turning.c - contacts that turn within the step: a disc off a disc, a disc in a fine bowl, and the same bits at every
// width and with any number of threads.
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "harness/near.h"
#include "harness/sim.h"

#define G        9.81
#define HZ60     (1 / 60.0)
#define MOST     4001
#define RADIUS   2.0
#define BALL     0.3
#define ARC_TURN 0.7 // [rad] amplitude

// A disc in a bowl of so many lines, on its slope.
static plumb_body add_bowl(plumb_world *w, plumb_material m, int lines, double x)
{
    static plumb_vec2 points[MOST];
    for (int i = 0; i <= lines; ++i) {
        const double u = -SIM_PI + SIM_PI * i / lines;
        points[i] = (plumb_vec2){ (plumb_real)(RADIUS * cos(u)), (plumb_real)(RADIUS * sin(u)) };
    }
    plumb_body bowl = plumb_body_create(
        w, &(plumb_body_desc){ .type = PLUMB_STATIC, .position = { (plumb_real)x, 0 } });
    plumb_shape_create(
        w, bowl,
        &(plumb_shape_desc){
            .kind = PLUMB_CHAIN, .points = points, .count = lines + 1, .material = m });
    const double ring = RADIUS - BALL;
    return sim_ball(w, x + ring * sin(ARC_TURN), -ring * cos(ARC_TURN), BALL, m);
}

// What a disc that rolls in the bowl has of its energy, as the turn that it would come to rest at. [rad]
static double amplitude(const plumb_world *w, plumb_body b)
{
    const double v = hypot(sim_vx(w, b), sim_vy(w, b)), spin = BALL * sim_w(w, b);
    const double up = (v * v + spin * spin / 2) / (2 * G) + sim_y(w, b);
    return acos(-up / (RADIUS - BALL));
}

// Frozen over the step, normals took 15 % of the amplitude in 20 s.
static void a_disc_rolls_on_in_a_bowl(void **state)
{
    (void)state;
    plumb_world *w = sim_world(&(plumb_world_desc){ .no_sleep = true, .gravity = sim_vec(0, -G) });
    plumb_body b = add_bowl(w, sim_material(w, 1, 0), 4000, 0);
    sim_run(w, 60 * 10, HZ60);
    const double off = amplitude(w, b) / ARC_TURN - 1;
    print_message("amplitude after 10 s: off by %.2g\n", off);
    assert_true(fabs(off) < 2e-3);
    plumb_world_destroy(w);
}

// Where a disc that slides off a fixed one leaves: cos(phi) = 2/3 cos(start). Its speed along x stays from there.
static double off_a_disc(int substeps)
{
    plumb_world *w = sim_world(
        &(plumb_world_desc){ .no_sleep = true, .gravity = sim_vec(0, -G), .substeps = substeps });
    plumb_material m = sim_material(w, 0, 0);
    plumb_body below = plumb_body_create(w, &(plumb_body_desc){ .type = PLUMB_STATIC });
    plumb_shape_create(w, below,
                       &(plumb_shape_desc){ .kind = PLUMB_CIRCLE, .radius = 2, .material = m });
    const double start = 0.1, ring = 2.5, leaves = acos(2.0 / 3 * cos(start));
    plumb_body b = sim_ball(w, ring * sin(start), ring * cos(start), 0.5, m);
    sim_run(w, 105, HZ60);
    const double vx = sqrt(2 * G * ring * (cos(start) - cos(leaves))) * cos(leaves);
    const double off = sim_vx(w, b) - vx;
    plumb_world_destroy(w);
    return fabs(off);
}

// With normals of the step's beginning: 0.028 m/s, and 0.059 with 16 substeps.
static void a_disc_leaves_where_nothing_holds_it(void **state)
{
    (void)state;
    const double four = off_a_disc(4), sixteen = off_a_disc(16);
    print_message("off a disc: %.2g m/s with 4 substeps, %.2g with 16\n", four, sixteen);
    assert_true(four < 0.016);
    assert_true(sixteen < 0.004);
}

static plumb_world *make_many(int width, int workers)
{
    plumb_world *w =
        sim_world(&(plumb_world_desc){ .no_sleep = true, .simd_width = width, .workers = workers });
    plumb_material m = sim_material(w, 0.5, 0);
    for (int i = 0; i < 3; ++i) {
        add_bowl(w, m, 1000 + 1000 * i, 5 * i);
        for (int k = 0; k < 6; ++k) {
            sim_ball(w, 5 * i - 0.5 + 0.2 * k, 0.5 + 0.4 * k, 0.1 + 0.02 * k, m);
            sim_crate(w, 5 * i + 0.3 - 0.1 * k, 3 + 0.5 * k, 0.2, 0.1 + 0.01 * k, m);
        }
    }
    return w;
}

static void widths_and_threads_give_the_same_bits(void **state)
{
    (void)state;
    const int widths[] = { 4, 8, 16, 8 }, workers[] = { 1, 1, 1, 3 };
    uint64_t first = 0;
    for (int k = 0; k < 4; ++k) {
        plumb_world *w = make_many(widths[k], workers[k]);
        sim_run(w, 240, HZ60);
        const uint64_t hash = plumb_world_hash(w);
        first = k == 0 ? hash : first;
        assert_true(hash == first);
        plumb_world_destroy(w);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_disc_rolls_on_in_a_bowl),
        cmocka_unit_test(a_disc_leaves_where_nothing_holds_it),
        cmocka_unit_test(widths_and_threads_give_the_same_bits),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
