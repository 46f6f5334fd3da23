// test_impulses.c - what joints tell of a whole step (plumb_joint_impulse), against the momentum that they gave.
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "harness/near.h"
#include "harness/sim.h"

#define DT (1 / 60.0)

static const plumb_solver solvers[] = { PLUMB_SOLVER_SOFT, PLUMB_SOLVER_PGS, PLUMB_SOLVER_EXACT };
static const char *const names[] = { "soft", "pgs", "exact" };

static const plumb_material none = PLUMB_NULL_INIT;

// Two crates in space that a joint of each kind holds: in every step B's momentum changes by what the joint tells.
static void what_is_told_is_the_momentum_given(void **state)
{
    (void)state;
    for (int k = 0; k < 3; ++k) {
        double worst = 0, last = 0;
        for (int kind = PLUMB_REVOLUTE; kind <= PLUMB_CABLE; ++kind) {
            plumb_world *w = sim_world(&(plumb_world_desc){
                .solver = solvers[k], .zero_gravity = true, .no_sleep = true });
            plumb_joint_desc d = { .kind = (plumb_joint_kind)kind,
                                   .body_a = sim_crate(w, -0.5, 0, 0.4, 0.2, none),
                                   .body_b = sim_crate(w, 0.5, 0, 0.4, 0.2, none),
                                   .anchor_b = sim_vec(0.4, 0.1),
                                   .ground_a = sim_vec(-0.5, 3),
                                   .ground_b = sim_vec(0.5, 3),
                                   .axis = sim_vec(1, 0),
                                   .ratio = 1,
                                   .radius_a = (plumb_real)0.1,
                                   .radius_b = (plumb_real)-0.2,
                                   .pitch = 1,
                                   .max_force = 3,
                                   .max_torque = 1,
                                   .tell_impulse = true };
            if (kind == PLUMB_WHEEL || kind == PLUMB_MOUSE || kind == PLUMB_MOTOR) {
                d.hertz = 3;
            }
            sim_fit_joint(&d);
            d.tell_impulse = true;
            plumb_joint j = plumb_joint_create(w, &d);
            assert_false(plumb_is_null(j));
            sim_launch(w, d.body_b, 0.5, 2, 1);
            const double m = (double)plumb_body_mass(w, d.body_b);
            for (int i = 0; i < 60; ++i) {
                const double vx = sim_vx(w, d.body_b);
                sim_step(w, DT);
                const double given = m * (sim_vx(w, d.body_b) - vx);
                worst = fmax(worst, fabs((double)plumb_joint_impulse(w, j).x - given));
                last = fmax(last, fabs((double)plumb_joint_force(w, j).x * DT - given));
            }
            plumb_world_destroy(w);
        }
        print_message(
            "%s: impulses off by %.2g N s; the last substep's force times the step by %.2g\n",
            names[k], worst, last);
        assert_true(worst < SIM_TOLERANCE(2e-5, 1e-12));
        assert_true(k == 1 || last > 100 * worst); // pgs: one substep
    }
}

// A motor about the centre of what it turns gives its torque times the step; a rod bears its load's weight times the step.
static void motors_and_loads(void **state)
{
    (void)state;
    for (int k = 0; k < 3; ++k) {
        plumb_world *w = sim_world(&(plumb_world_desc){ .solver = solvers[k], .no_sleep = true });
        plumb_body wheel =
            plumb_body_create(w, &(plumb_body_desc){ .mass = 2, .inertia = 5, .gravity_scale = 1 });
        plumb_body load = plumb_body_create(
            w, &(plumb_body_desc){ .position = { 4, -1 }, .mass = 3, .inertia = 1 });
        plumb_joint motor = plumb_joint_create(w, &(plumb_joint_desc){ .kind = PLUMB_REVOLUTE,
                                                                       .body_b = wheel,
                                                                       .enable_motor = true,
                                                                       .motor_speed = 1000,
                                                                       .max_motor = 7,
                                                                       .tell_impulse = true });
        plumb_joint rod = plumb_joint_create(w, &(plumb_joint_desc){ .kind = PLUMB_DISTANCE,
                                                                     .body_b = load,
                                                                     .anchor = { 4, 0 },
                                                                     .anchor_b = { 4, -1 } });
        sim_run(w, 120, DT);
        assert_near(plumb_joint_angular_impulse(w, motor), 7 * DT, 1e-6);
        assert_int_equal(plumb_joint_impulse(w, rod).y, 0); // nobody asked
        assert_int_equal(plumb_world_error(w).code, PLUMB_E_STATE);
        assert_int_equal(plumb_joint_set_tell_impulse(w, rod, true), PLUMB_OK);
        sim_step(w, DT);
        assert_near(plumb_joint_impulse(w, rod).y, 3 * SIM_G * DT, 1e-4);
        plumb_world_destroy(w);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(what_is_told_is_the_momentum_given),
        cmocka_unit_test(motors_and_loads),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
