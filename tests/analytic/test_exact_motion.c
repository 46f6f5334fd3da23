// test_exact_motion.c - how things move by the exact solver: springs as their closed forms say, what joints and contacts push
// to second order in the substep, rods and slides without loss of energy.
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "harness/near.h"
#include "harness/sim.h"

#define DT (1 / 60.0)

static plumb_world *exact_space(double gravity)
{
    return sim_world(&(plumb_world_desc){ .solver = PLUMB_SOLVER_EXACT,
                                          .zero_gravity = gravity <= 0,
                                          .gravity = sim_vec(0, -gravity),
                                          .no_sleep = true });
}

static plumb_joint tie(plumb_world *w, plumb_joint_desc desc)
{
    plumb_joint joint = plumb_joint_create(w, &desc);
    assert_false(plumb_is_null(joint));
    return joint;
}

// A body on a line, held at 0 by a spring.
static plumb_body hold(plumb_world *w, double x, double y, double hertz, double damping)
{
    plumb_body b = sim_mass(w, x, y, 2, 1);
    tie(w, (plumb_joint_desc){ .kind = PLUMB_PRISMATIC,
                               .body_b = b,
                               .anchor = sim_vec(x, y),
                               .rest = (plumb_real)-x,
                               .hertz = (plumb_real)hertz,
                               .damping = (plumb_real)damping });
    return b;
}

// Place of an oscillator that was let go at 1, or sent off from 0 at the speed 1.
static double place(double hertz, double z, double t, bool sent)
{
    const double w = 2 * SIM_PI * hertz, q = w * sqrt(fabs(1 - z * z));
    if (z > 1) {
        const double slow = exp(-w * w / (z * w + q) * t), fast = exp(-(z * w + q) * t);
        const double s = (slow - fast) / (2 * q);
        return sent ? s : (slow + fast) / 2 + z * w * s;
    }
    const double left = exp(-z * w * t), s = z < 1 ? sin(q * t) / q : t;
    return left * (sent ? s : cos(q * t) + z * w * s);
}

static void springs_are_the_oscillator(void **state)
{
    (void)state;
    const double hertz[] = { 0.2, 1, 5, 20 }, damping[] = { 0, 0.05, 0.5, 1, 2, 10 };
    double worst = 0, worst_sent = 0;
    for (int i = 0; i < 48; ++i) {
        const double f = hertz[i % 4], z = damping[i / 4 % 6];
        const bool sent = i >= 24;
        plumb_world *w = exact_space(0);
        plumb_body b = hold(w, sent ? 0 : 1, 0, f, z);
        sim_launch(w, b, sent ? 1 : 0, 0, 0);
        const double x = 2 * SIM_PI * f * DT / 4; // of velocities: x^2 / 6
        for (int k = 1; k <= 180; ++k) {
            sim_step(w, DT);
            const double off = fabs(sim_x(w, b) - place(f, z, k * DT, sent));
            if (sent) {
                worst_sent = fmax(worst_sent, off * 2 * SIM_PI * f / (x * x / 6 + 1e-3));
            } else {
                worst = fmax(worst, off);
            }
        }
        plumb_world_destroy(w);
    }
    print_message("springs let go: within %.2g of 1 m; sent off: %.2g of x^2 / 6\n", worst,
                  worst_sent);
    assert_true(worst < SIM_TOLERANCE(2e-5, 1e-10));
    assert_true(worst_sent < 1.5);
}

// Many springs on one body, and bodies in a row: without damping nothing is won, however stiff they are.
static void springs_that_meet_win_nothing(void **state)
{
    (void)state;
    const double hertz[] = { 2, 15, 25, 40, 60, 90, 120, 1000, 1e5 };
    const int counts[] = { 1, 2, 5, 16 };
    double worst = 0;
    for (size_t i = 0; i < 36; ++i) {
        plumb_world *w = exact_space(0);
        const int n = counts[i / 9];
        const double f = hertz[i % 9];
        double most = 0;
        plumb_body one = sim_mass(w, 0, 0, 1, 1);
        for (int k = 0; k < n; ++k) {
            tie(w, (plumb_joint_desc){ .kind = PLUMB_PRISMATIC,
                                       .body_b = one,
                                       .hertz = (plumb_real)(f * (1 + 0.01 * k)) });
        }
        sim_launch(w, one, 1, 0, 0);
        plumb_body row[8], before = { 0 };
        for (int k = 0; k < 8; ++k) {
            row[k] = sim_mass(w, k, 5, k % 2 == 0 ? 1 : 10, 1);
            tie(w, (plumb_joint_desc){ .kind = PLUMB_PRISMATIC,
                                       .body_a = before,
                                       .body_b = row[k],
                                       .anchor = sim_vec(k, 5),
                                       .hertz = (plumb_real)f });
            before = row[k];
        }
        sim_launch(w, row[3], 1, 0, 0);
        for (int k = 0; k < 600; ++k) {
            sim_step(w, DT);
            most = fmax(most, sim_max_speed(w));
        }
        if (most > worst) {
            print_message("%d springs of %g Hz: 1 m/s at first, %.3f at most\n", n, f, most);
        }
        worst = fmax(worst, most);
        plumb_world_destroy(w);
    }
    print_message("springs that meet: 1 m/s at first, %.3f at most\n", worst);
    assert_true(worst < 1.5);
}

// A motor of constant torque, a slide of constant push: half of a t^2, not of a t (t + h).
static void what_is_pushed_moves_to_second_order(void **state)
{
    (void)state;
    plumb_world *w = exact_space(0);
    plumb_body arm = sim_mass(w, 0, 0, 2, 0.5);
    tie(w, (plumb_joint_desc){ .kind = PLUMB_REVOLUTE,
                               .body_b = arm,
                               .enable_motor = true,
                               .motor_speed = 1e6f,
                               .max_motor = 1 });
    plumb_body sled = sim_mass(w, 10, 0, 3, 1);
    tie(w, (plumb_joint_desc){ .kind = PLUMB_PRISMATIC,
                               .body_b = sled,
                               .anchor = sim_vec(10, 0),
                               .enable_motor = true,
                               .motor_speed = 1e6f,
                               .max_motor = 6 });
    sim_run(w, 90, DT);
    const double t = 1.5, turn = sim_angle(w, arm), way = sim_x(w, sled) - 10;
    print_message("1 N m on 0.5 kg m^2: %.6f rad, exact %.6f; 6 N on 3 kg: %.6f m, exact %.6f\n",
                  turn, t * t, way, t * t);
    assert_near(turn, t * t, SIM_TOLERANCE(1e-5, 1e-12));
    assert_near(way, t * t, SIM_TOLERANCE(1e-5, 1e-12));
    plumb_world_destroy(w);
}

// A point on a rod, on a rope, and on a slide that turns: rows that are no points bend within the substep.
static void rows_that_turn_keep_energy(void **state)
{
    (void)state;
    double energy = 0, longer = 0;
    plumb_world *w = exact_space(SIM_G);
    plumb_body bob[2];
    for (int i = 0; i < 2; ++i) {
        bob[i] = sim_mass(w, 10 * i + 1, 0, 1, 1e-3);
        tie(w, (plumb_joint_desc){ .kind = PLUMB_DISTANCE,
                                   .body_b = bob[i],
                                   .anchor = sim_vec(10 * i, 0),
                                   .anchor_b = sim_vec(10 * i + 1, 0),
                                   .enable_limit = i == 1,
                                   .upper = i == 1 ? 1 : 0 });
    }
    for (int k = 0; k < 600; ++k) {
        sim_step(w, DT);
        for (int i = 0; i < 2; ++i) {
            const double x = sim_x(w, bob[i]) - 10 * i, y = sim_y(w, bob[i]);
            const double v = hypot(sim_vx(w, bob[i]), sim_vy(w, bob[i]));
            energy = fmax(energy, fabs(v * v / 2 + SIM_G * y) / SIM_G);
            longer = fmax(longer, fabs(hypot(x, y) - 1));
        }
    }
    print_message(
        "swings on a rod and a rope for 10 s: energy within %.2g of a swing's, length %.2g m\n",
        energy, longer);
    assert_true(energy < 2e-4);
    assert_true(longer < 1e-4);
    plumb_world_destroy(w);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(springs_are_the_oscillator),
        cmocka_unit_test(springs_that_meet_win_nothing),
        cmocka_unit_test(what_is_pushed_moves_to_second_order),
        cmocka_unit_test(rows_that_turn_keep_energy),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
