// test_joints.c - joints against closed forms: pendulums, springs, statics of reactions, machines. Each
// case prints what it measured; the table of joints/README.md is from here.
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "harness/sim.h"

#define DT (1 / 60.0)

static plumb_material none(void)
{
    return (plumb_material)PLUMB_NULL_INIT;
}

static plumb_joint tie(plumb_world *w, plumb_joint_desc desc)
{
    plumb_joint joint = plumb_joint_create(w, &desc);
    assert_false(plumb_is_null(joint));
    return joint;
}

// [kg] body without shape: a point mass, or with inertia.
static plumb_body mass(plumb_world *w, double x, double y, double kg, double inertia)
{
    plumb_body b =
        plumb_body_create(w, &(plumb_body_desc){ .position = sim_vec(x, y),
                                                 .mass = (plumb_real)kg,
                                                 .inertia = (plumb_real)inertia });
    assert_false(plumb_is_null(b));
    return b;
}

static double value(const plumb_world *w, plumb_joint j)
{
    return (double)plumb_joint_value(w, j);
}

// Period of a pendulum of amplitude a: 2 pi sqrt(L/g) / agm(1, cos(a / 2)).
static double pendulum_period(double length, double amplitude)
{
    double x = 1, y = cos(amplitude / 2);
    for (int i = 0; i < 10; ++i) {
        double mean = (x + y) / 2;
        y = sqrt(x * y);
        x = mean;
    }
    return 2 * SIM_PI * sqrt(length / SIM_G) / x;
}

// Mean period over `swings` full swings, from crossings of the vertical, and the last amplitude.
static double measure_period(plumb_world *w, plumb_body b, int swings, double *amplitude)
{
    double first = 0, t = 0, last_x = sim_x(w, b), largest = 0;
    int crossings = 0;
    while (crossings < 2 * swings + 1 && t < 200) {
        sim_step(w, DT);
        t += DT;
        double x = sim_x(w, b), y = sim_y(w, b);
        if (crossings > 2 * swings - 2) {
            largest = fmax(largest, fabs(atan2(x, -y)));
        }
        if ((x > 0) != (last_x > 0)) {
            double at = t - DT * x / (x - last_x);
            first = crossings == 0 ? at : first;
            if (++crossings == 2 * swings + 1) {
                *amplitude = largest;
                return (at - first) / swings;
            }
        }
        last_x = x;
    }
    return 0;
}

static void pendulum_keeps_period_and_amplitude(void **state)
{
    (void)state;
    const double amplitudes[] = { 5, 30, 60, 90, 120 };
    for (int kind = 0; kind < 2; ++kind) {
        for (size_t k = 0; k < sizeof amplitudes / sizeof amplitudes[0]; ++k) {
            double a = amplitudes[k] * SIM_PI / 180;
            plumb_world *w = sim_world(&(plumb_world_desc){ 0 });
            plumb_body b = mass(w, sin(a), -cos(a), 2, 0);
            plumb_joint j =
                kind == 0
                    ? tie(w, (plumb_joint_desc){ .kind = PLUMB_DISTANCE,
                                                 .body_a = b,
                                                 .anchor = plumb_body_position(w, b) })
                    : tie(w, (plumb_joint_desc){ .kind = PLUMB_REVOLUTE, .body_b = b });
            if (kind == 1) { // physical pendulum: inertia m L^2 / 2 makes it 1.5 times as long
                plumb_joint_destroy(w, j);
                plumb_body_destroy(w, b);
                b = mass(w, sin(a), -cos(a), 2, 1);
                j = tie(w, (plumb_joint_desc){ .kind = PLUMB_REVOLUTE, .body_b = b });
            }
            double kept = 0, measured = measure_period(w, b, 10, &kept);
            double wanted = pendulum_period(kind == 0 ? 1 : 1.5, a);
            print_message("pendulum %-8s %3.0f deg: period %.5f s, exact %.5f (%+.3f %%), after 10 "
                          "swings %.3f deg, drift %.2g m\n",
                          kind == 0 ? "rod" : "hinge", amplitudes[k], measured, wanted,
                          100 * (measured / wanted - 1), kept * 180 / SIM_PI,
                          (double)plumb_joint_error(w, j));
            assert_true(fabs(measured / wanted - 1) < 0.01);
            assert_true(fabs(kept / a - 1) < 0.03);
            plumb_world_destroy(w);
        }
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(pendulum_keeps_period_and_amplitude),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
