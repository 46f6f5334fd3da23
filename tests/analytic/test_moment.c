// test_moment.c - when in a step a blow fell, against the time of a fall, sqrt(2 h / g); contacts that turn within a step leave
// locked axes alone.
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "harness/near.h"
#include "harness/random.h"
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

// [m] how far the centre of a body with a locked axis got along it, at the most, where others turn and strike it.
static double strayed(plumb_solver solver, bool coarse, uint32_t seed)
{
    enum { BODIES = 12 };
    plumb_world *w = sim_world(&(plumb_world_desc){ .solver = solver, .no_fine_islands = coarse });
    const plumb_material m = sim_material(w, 0.6, 0);
    plumb_body body[BODIES];
    double from[BODIES], most = 0;
    sim_floor(w, m);
    for (int i = 0; i < BODIES; ++i) {
        const double x = sim_uniform(&seed, -2, 2), y = sim_uniform(&seed, 0.5, 5);
        body[i] = i % 2 == 0 ? sim_ball(w, x, y, 0.25, m) : sim_crate(w, x, y, 0.3, 0.2, m);
        plumb_body_set_velocity(w, body[i], plumb_v2((plumb_real)sim_uniform(&seed, -5, 5), 0));
        plumb_body_set_angular_velocity(w, body[i], (plumb_real)sim_uniform(&seed, -20, 20));
        plumb_body_set_locks(w, body[i], (plumb_axis_locks){ .x = i % 3 == 0, .y = i % 3 == 1 });
        const plumb_vec2 at = plumb_body_center(w, body[i]);
        from[i] = (double)(i % 3 == 0 ? at.x : at.y);
    }
    for (int step = 0; step < 60; ++step) {
        sim_step(w, DT);
        for (int i = 0; i < BODIES; ++i) {
            const plumb_vec2 at = plumb_body_center(w, body[i]);
            most =
                i % 3 == 2 ? most : fmax(most, fabs((double)(i % 3 == 0 ? at.x : at.y) - from[i]));
        }
    }
    plumb_world_destroy(w);
    return most;
}

static void locked_axes_stay_locked_where_contacts_turn(void **state)
{
    (void)state;
    for (int solver = PLUMB_SOLVER_SOFT; solver <= PLUMB_SOLVER_EXACT; ++solver) {
        double most = 0;
        for (uint32_t seed = 1; seed <= 10; ++seed) {
            most = fmax(most, strayed((plumb_solver)solver, seed % 2 == 0, seed * 7919));
        }
        print_message("solver %d: along a locked axis %.3g m\n", solver, most);
        assert_true(most == 0);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_blow_tells_its_moment),
        cmocka_unit_test(locked_axes_stay_locked_where_contacts_turn),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
