// test_moment.c - when in a step a blow fell, against the time of a fall, sqrt(2 h / g).
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "harness/near.h"
#include "harness/sim.h"

#define DT     (1 / 60.0)
#define RADIUS 0.25

// [s] at which the first hit of a ball that is let go `height` above a floor fell.
static double time_of_hit(plumb_solver solver, double restitution, double height, double *moment)
{
    plumb_world *w = sim_world(&(plumb_world_desc){ .solver = solver, .hit_speed = 1 });
    plumb_material m = sim_material(w, 0.5, restitution);
    sim_floor(w, m);
    sim_ball(w, 0, RADIUS + height, RADIUS, m);
    double at = -1;
    for (int i = 0; i < 120 && at < 0; ++i) {
        sim_step(w, DT);
        int count;
        const plumb_contact_hit *hit = plumb_world_hit_events(w, &count);
        if (count > 0) {
            *moment = (double)hit->moment;
            at = plumb_world_stats(w).time - DT + *moment;
        }
    }
    plumb_world_destroy(w);
    return at;
}

// A blow that bounces is put at its moment, to rounding; one that does not, to what gravity
// makes of a substep: 2 g h^2 over a metre a second.
static void a_blow_tells_its_moment(void **state)
{
    (void)state;
    static const char *const names[] = { "soft", "pgs", "exact" };
    for (int solver = PLUMB_SOLVER_SOFT; solver <= PLUMB_SOLVER_EXACT; ++solver) {
        const double es[] = { 0, 0.3, 0.95, 1 };
        for (int k = 0; k < 4; ++k) {
            double worst = 0, least = DT, most = -DT;
            for (double height = 0.5; height < 2; height += 0.043) {
                double moment = 0;
                const double at = time_of_hit((plumb_solver)solver, es[k], height, &moment);
                worst = fmax(worst, fabs(at - sqrt(2 * height / SIM_G)));
                least = fmin(least, moment);
                most = fmax(most, moment);
            }
            print_message("%s, e = %.2f: moment off by %.3g s at most, %.3g to %.3g s\n",
                          names[solver], es[k], worst, least, most);
            const double substep = solver == PLUMB_SOLVER_PGS ? DT : DT / 4;
            assert_true(worst <= (es[k] > 0 ? ROUNDED(2e-6) : 2 * SIM_G * substep * substep));
            assert_true(least >= -DT && most <= DT * 1.0001 && most - least > 0.8 * DT);
        }
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_blow_tells_its_moment),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
