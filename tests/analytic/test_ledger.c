// test_ledger.c - heaps among fluids, engines and bodies whose time stands still: the ledger of each step (plumb/measure.h) is
// closed, what it cannot explain is rounding; and bodies that are cut, shatter and become one keep momentum and mass.
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "harness/near.h"
#include "harness/random.h"
#include "harness/sim.h"

#define R(x) ((plumb_real)(x))

enum { BODIES = 8, STEPS = 100, SEEDS = 4 };

typedef enum feature { FROZEN, SLOWED, WIND, WATER, WAVES, ROCKET, FEATURES } feature;

static const char *const names[] = {
    "time that stands still", "slow motion", "wind", "water", "waves", "a rocket"
};

static void add_fluid(plumb_world *w, feature f)
{
    const plumb_material m = plumb_material_create(
        w, &(plumb_material_desc){
               .fluid = true, .density = f == WIND ? R(1.2) : 2, .flow_x = f == WIND ? 5 : 0 });
    const plumb_body holder = plumb_body_create(w, &(plumb_body_desc){ .type = PLUMB_STATIC });
    const plumb_shape shape = plumb_shape_create(w, holder,
                                                 &(plumb_shape_desc){ .kind = PLUMB_BOX,
                                                                      .half = { 5, 2 },
                                                                      .center = { 0, 1 },
                                                                      .sensor = true,
                                                                      .material = m });
    if (f == WAVES) {
        plumb_waves_create(w, shape, &(plumb_waves_desc){ .modes = 8 });
    }
}

static void set_up(plumb_world *w, feature f, uint32_t *seed)
{
    const plumb_material m = sim_material(w, 0.5, 0);
    sim_floor(w, m);
    plumb_body body[BODIES];
    for (int i = 0; i < BODIES; ++i) {
        const double x = i % 4 * 2 - 4 + sim_uniform(seed, -0.2, 0.2);
        const double y = 1 + i / 4 * 1.5 + sim_uniform(seed, 0, 0.5);
        const double size = sim_uniform(seed, 0.2, 0.5);
        body[i] = i % 2 == 0 ? sim_ball(w, x, y, size, m) : sim_crate(w, x, y, size, 0.3, m);
        plumb_body_set_velocity(w, body[i],
                                plumb_v2(R(sim_uniform(seed, -2, 2)), R(sim_uniform(seed, -2, 2))));
        plumb_body_set_angular_velocity(w, body[i], R(sim_uniform(seed, -2, 2)));
    }
    if (f == FROZEN || f == SLOWED) {
        plumb_body_set_time_scale(w, body[1], f == FROZEN ? 0 : R(0.5));
    } else if (f == ROCKET) {
        plumb_body_set_thrust(w, body[1], 5);
        plumb_body_set_thrust_y(w, body[1], R(0.1));
        plumb_body_set_exhaust(w, body[1], 50);
        plumb_body_set_fuel(w, body[1], R(0.2));
    } else {
        add_fluid(w, f);
    }
}

// [-] what a step cannot explain, against what it can and the energy that there is.
static double unexplained(const plumb_world *w)
{
    const plumb_measures *m = plumb_world_measures(w);
    const plumb_balance rest = m->work[PLUMB_WORK_REST];
    double moved = plumb_world_energy(w).kinetic + 0.1;
    for (int i = 0; i < PLUMB_WORK_REST; ++i) {
        moved += fabs(m->work[i].kinetic) + fabs(m->work[i].potential);
    }
    return fabs(rest.kinetic + rest.potential) / moved;
}

static void the_ledger_is_closed(void **state)
{
    (void)state;
    for (int f = 0; f < FEATURES; ++f) {
        for (int solver = PLUMB_SOLVER_SOFT; solver <= PLUMB_SOLVER_EXACT; ++solver) {
            double worst = 0;
            for (uint32_t n = 1; n <= SEEDS; ++n) {
                uint32_t seed = n * 7919;
                plumb_world *w = sim_world(&(plumb_world_desc){ .solver = (plumb_solver)solver,
                                                                .measure = true,
                                                                .no_fine_islands = n % 2 == 0 });
                set_up(w, (feature)f, &seed);
                for (int step = 0; step < STEPS; ++step) {
                    sim_step(w, 1 / 60.0);
                    worst = fmax(worst, unexplained(w));
                }
                plumb_world_destroy(w);
            }
            print_message("%s, solver %d: %.2g is unexplained\n", names[f], solver, worst);
            assert_true(worst < 1e-4);
        }
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_ledger_is_closed),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
