// test_ledger.c - heaps among fluids, engines and bodies whose time stands still: the ledger of each step (plumb/measure.h) is
// closed, what it cannot explain is rounding; and bodies that are cut, shatter and become one keep momentum and mass; crowds of joints keep momentum.
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

//---- joints --------------------------------------------------------------------------------------

// Rope, rod, slider, wheel, hinge, weld between two bodies.
static void add_joint(plumb_world *w, int kind, plumb_body a, plumb_body b)
{
    const plumb_vec2 from = plumb_body_center(w, a), to = plumb_body_center(w, b);
    const plumb_vec2 middle = { (from.x + to.x) / 2, (from.y + to.y) / 2 };
    const plumb_joint_desc joints[] = {
        { .kind = PLUMB_DISTANCE,
          .anchor = from,
          .anchor_b = to,
          .enable_limit = true,
          .upper = 1 },
        { .kind = PLUMB_DISTANCE, .anchor = from, .anchor_b = to },
        { .kind = PLUMB_PRISMATIC, .enable_motor = true, .motor_speed = 1, .max_motor = 3 },
        { .kind = PLUMB_WHEEL, .hertz = 3, .damping = R(0.2) },
        { .kind = PLUMB_REVOLUTE },
        { .kind = PLUMB_WELD },
    };
    plumb_joint_desc d = joints[kind];
    d.body_a = a, d.body_b = b;
    d.anchor = kind < 2 ? from : middle;
    assert_false(plumb_is_null(plumb_joint_create(w, &d)));
}

enum { JOINT_KINDS = 6, CROWD = 12 };

// The most by which a step changes the momentum of a crowd that flies together, part of it made inside of one another: of the sum
// of its bodies' at its largest.
static double most_lost(int kind, bool fine, uint32_t seed)
{
    plumb_world *w = NULL;
    plumb_body body[CROWD];
    const plumb_world_desc desc = { .zero_gravity = true, .no_fine_islands = !fine };
    assert_int_equal(plumb_world_create(&desc, &w), PLUMB_OK);
    double scale = 0, most = 0;
    for (int i = 0; i < CROWD; ++i) {
        const double x = sim_uniform(&seed, -2, 2), y = sim_uniform(&seed, -2, 2);
        body[i] = i % 2 == 0 ? sim_ball(w, x, y, 0.3, sim_material(w, 0.5, 0))
                             : sim_crate(w, x, y, 0.3, 0.25, sim_material(w, 0.5, 0));
        plumb_body_set_velocity(
            w, body[i],
            plumb_v2(R(sim_uniform(&seed, -1, 1) - 2 * x), R(sim_uniform(&seed, -1, 1) - 2 * y)));
        plumb_body_set_angular_velocity(w, body[i], R(sim_uniform(&seed, -4, 4)));
        scale +=
            (double)plumb_body_mass(w, body[i]) * hypot((double)plumb_body_velocity(w, body[i]).x,
                                                        (double)plumb_body_velocity(w, body[i]).y);
    }
    for (int i = 0; i + 1 < CROWD; i += 2) {
        add_joint(w, kind, body[i], body[i + 1]);
    }
    plumb_energy before = plumb_world_energy(w);
    for (int i = 0; i < 60; ++i) {
        sim_step(w, i % 7 == 3 ? 0.7 / 60 : 1 / 60.0);
        const plumb_energy now = plumb_world_energy(w);
        const double lost = hypot((double)now.momentum_x - (double)before.momentum_x,
                                  (double)now.momentum_y - (double)before.momentum_y);
        most = lost > most ? lost : most;
        before = now;
    }
    plumb_world_destroy(w);
    return most / scale;
}

static void crowds_of_joints_keep_momentum(void **state)
{
    (void)state;
    for (int kind = 0; kind < JOINT_KINDS; ++kind) {
        for (uint32_t seed = 1; seed <= 12; ++seed) {
            const double lost = most_lost(kind, seed % 2 == 0, seed * 7919);
            if (lost > 5e-5) {
                fail_msg("joints of kind %d, seed %u: a step changes momentum by %g", kind,
                         (unsigned)seed, lost);
            }
        }
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_ledger_is_closed),
        cmocka_unit_test(crowds_of_joints_keep_momentum),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
