// test_rush.c - one of a loose heap goes at up to a million metres a second, or turns a million radians a second, and is struck: a step
// looks at contacts a bounded number of times, and nobody gains what was not there. Float, double, far.
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "harness/sim.h"
#include "world/state.h"

enum { SIDE = 20, STEPS = 6 };

// A look a candidate and its like: before there was an end to them it was 190, of as many more candidates, and a step of 1,000 boxes
// took half a minute.
#define LOOKS_MOST 6

static plumb_body put(plumb_world *w, unsigned *seed, int form, int i, plumb_material m)
{
    const double x = 1.1 * (i % SIDE), y = 1.1 * (i / SIDE);
    const plumb_body b =
        form == 1 ? sim_ball(w, x, y, 0.5, m) : sim_crate(w, x, y, 0.5, form == 0 ? 0.5 : 0.1, m);
    sim_launch(w, b, sim_uniform(seed, -1, 1), sim_uniform(seed, -1, 1), sim_uniform(seed, -1, 1));
    return b;
}

// Looks, over the candidates of the last look of the step.
static double looks_of(const plumb_world *w)
{
    return (double)w->lookahead.looks / (w->narrow.candidate_count + 256.0);
}

static void what_is_struck_by_all_is_not_looked_at_for_ever(void **state)
{
    (void)state;
    const double bounces[] = { 0, 0.3, 0.9 }, speeds[] = { 0, 100, 1e4, 1e6 };
    const double spins[] = { 0, 1e3, 1e5, 1e6 };
    double most = 0, gain = 0;
    for (int k = 0; k < 3 * 3 * 4 * 4; ++k) {
        unsigned seed = (unsigned)k;
        const int form = k % 3;
        const double speed = speeds[k / 9 % 4], spin = spins[k / 36];
        plumb_world *w = sim_space();
        plumb_body body[SIDE * SIDE];
        const plumb_material m = sim_material(w, 0.3, bounces[k / 3 % 3]);
        for (int i = 0; i < SIDE * SIDE; ++i) {
            body[i] = put(w, &seed, form, i, m);
        }
        sim_run(w, 3, 1 / 60.0);
        sim_launch(w, body[SIDE * SIDE / 2 + 7], 0.8 * speed, 0.6 * speed, spin);
        const double before = sim_energy(w);
        for (int i = 0; i < STEPS; ++i) {
            sim_step(w, 1 / 60.0);
            most = fmax(most, looks_of(w));
            gain = fmax(gain, sim_energy(w) / before - 1);
        }
        assert_true(most < LOOKS_MOST);
        plumb_world_destroy(w);
    }
    print_message("%.2f looks a candidate at the most; energy up by %.2g of it\n", most, gain);
    assert_true(gain < 1e-3);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(what_is_struck_by_all_is_not_looked_at_for_ever),
    };
    return cmocka_run_group_tests_name("rush", tests, NULL, NULL);
}
