// test_joints.c - joints against closed forms: pendulums, springs, statics of reactions, machines.
// Each case prints what it measured; the table of joints/DECISIONS.md is from here.
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "harness/near.h"
#include "harness/sim.h"

#define DT (1 / 60.0)

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
            plumb_body b = sim_mass(w, sin(a), -cos(a), 2, 0);
            plumb_joint j =
                kind == 0 ? sim_joint(w, (plumb_joint_desc){ .kind = PLUMB_DISTANCE,
                                                             .body_a = b,
                                                             .anchor = plumb_body_position(w, b) })
                          : sim_joint(w, (plumb_joint_desc){ .kind = PLUMB_REVOLUTE, .body_b = b });
            if (kind == 1) { // physical pendulum: inertia m L^2 / 2 makes it 1.5 times as long
                plumb_joint_destroy(w, j);
                plumb_body_destroy(w, b);
                b = sim_mass(w, sin(a), -cos(a), 2, 1);
                j = sim_joint(w, (plumb_joint_desc){ .kind = PLUMB_REVOLUTE, .body_b = b });
            }
            double kept = 0, measured = measure_period(w, b, 10, &kept);
            double wanted = pendulum_period(kind == 0 ? 1 : 1.5, a);
            print_message("pendulum %-8s %3.0f deg: period %.5f s, exact %.5f (%+.3f %%), after 10 "
                          "swings %.3f deg, drift %.2g m\n",
                          kind == 0 ? "rod" : "hinge", amplitudes[k], measured, wanted,
                          100 * (measured / wanted - 1), kept * 180 / SIM_PI,
                          (double)plumb_joint_error(w, j));
            assert_near(measured / wanted, 1, kind == 0 ? 0.002 : 1e-4);
            assert_near(kept / a, 1, kind == 0 ? 0.006 : 4e-4);
            plumb_world_destroy(w);
        }
    }
}

// A rod falls from the level about a hinge at its end. At the lowest point w^2 L = 3 g, the centre
// is at L / 2: the hinge pulls by m g + m w^2 L / 2 = 2.5 m g.
static void rod_pulls_at_its_hinge(void **state)
{
    (void)state;
    plumb_world *w = sim_world(&(plumb_world_desc){ 0 });
    const double length = 2, kg = 3;
    plumb_body rod = sim_mass(w, length / 2, 0, kg, kg * length * length / 12);
    plumb_joint j = sim_joint(w, (plumb_joint_desc){ .kind = PLUMB_REVOLUTE, .body_b = rod });
    double largest = 0;
    for (int i = 0; i < 120; ++i) {
        sim_step(w, DT);
        largest = fmax(largest, (double)plumb_joint_force(w, j).y);
    }
    double wanted = 2.5 * kg * SIM_G;
    print_message("rod on a hinge: largest pull %.3f N, exact %.3f (%+.2f %%)\n", largest, wanted,
                  100 * (largest / wanted - 1));
    assert_near(largest / wanted, 1, 0.02);
    plumb_world_destroy(w);
}

// What is left after 1 s of the spin of a free rod of 4 m, hinged at its end to the world, or at that of a
// rod like it; how far the anchors came apart. Alone: a hinge that may break is not solved in lanes.
static double spin_kept(double spin, int substeps, bool paired, bool alone, double *apart)
{
    plumb_world *w = sim_world(&(plumb_world_desc){ .zero_gravity = true, .substeps = substeps });
    const double half = 2, kg = 3, inertia = kg * half * half / 3;
    plumb_body rod = sim_mass(w, half, 0, kg, inertia), other = PLUMB_NULL_INIT;
    sim_launch(w, rod, 0, spin * half, spin);
    if (paired) {
        other = sim_mass(w, -half, 0, kg, inertia);
        sim_launch(w, other, 0, -spin * half, spin);
    }
    plumb_joint_desc desc = { .kind = PLUMB_REVOLUTE, .body_a = rod, .body_b = other };
    desc.break_impulse = alone ? (plumb_real)1e9 : 0;
    plumb_joint j = sim_joint(w, desc);
    *apart = 0;
    for (int i = 0; i < 60; ++i) {
        sim_step(w, DT);
        *apart = fmax(*apart, (double)plumb_joint_error(w, j));
    }
    double kept = sim_w(w, rod) / spin;
    plumb_world_destroy(w);
    return kept;
}

// The exact rod keeps all its spin. What the hinge gives costs some of it, by the square of the turn in a
// substep or faster. Without arcs (joints/solve.c) 0.003, 0.015, 0.09, 0.36 and 0.65 would be lost.
static void spinning_rod_keeps_its_spin(void **state)
{
    (void)state;
    const double spins[] = { 8, 16, 32, 64, 128 };
    const double lost[] = { 2e-4, 1.2e-3, 9e-3, 0.09, 0.45 };
    const double gaps[] = { 4e-4, 1.6e-3, 6.4e-3, 0.026, 0.15 };
    for (int i = 0; i < 5; ++i) {
        double gap, pair_gap, alone_gap;
        double kept = spin_kept(spins[i], 4, false, false, &gap);
        double pair = spin_kept(spins[i], 4, true, false, &pair_gap);
        double alone = spin_kept(spins[i], 4, false, true, &alone_gap);
        print_message(
            "rod at %3.0f rad/s: %.5f of it after 1 s, %.2g m apart; two rods %.5f, %.2g m\n",
            spins[i], kept, gap, pair, pair_gap);
        assert_true(fabs(kept - 1) < lost[i] && gap < gaps[i]);
        assert_true(fabs(pair - 1) < lost[i] && pair_gap < 2.5 * gaps[i]);
        assert_true(fabs(alone - kept) < 1e-4 && fabs(alone_gap - gap) < 1e-3 * gap);
    }
    double loss[3], gap[3];
    for (int k = 0; k < 3; ++k) {
        loss[k] = 1 - spin_kept(32, 4 << k, false, false, &gap[k]);
    }
    print_message("order in the substep: loss %.2f, gap %.2f\n", sim_order(loss, 3),
                  sim_order(gap, 3));
    assert_true(sim_order(loss, 3) > 2.3 && sim_order(gap, 3) > 1.9);
}

// Hung on a joint and at rest: the reaction is the weight, torque that of the arm.
static void reactions_at_rest_are_the_weight(void **state)
{
    (void)state;
    const plumb_joint_desc kinds[] = {
        { .kind = PLUMB_REVOLUTE, .anchor = { 0, 2 } },
        { .kind = PLUMB_WELD, .anchor = { 1, 0 } },
        { .kind = PLUMB_DISTANCE, .anchor = { 0, 3 } },
        { .kind = PLUMB_PRISMATIC, .anchor = { 1, 0 } },
        { .kind = PLUMB_MOTOR, .anchor = { 1, 0 } },
        { .kind = PLUMB_FRICTION, .anchor = { 1, 0 }, .max_force = 100, .max_torque = 100 },
        { .kind = PLUMB_MOUSE },
    };
    for (size_t k = 0; k < sizeof kinds / sizeof kinds[0]; ++k) {
        plumb_world *w = sim_world(&(plumb_world_desc){ 0 });
        plumb_joint_desc d = kinds[k];
        d.body_b = sim_mass(w, 0, 0, 2, 0.5);
        plumb_joint j = sim_joint(w, d);
        sim_run(w, 600, DT);
        plumb_vec2 f = plumb_joint_force(w, j);
        double torque = (double)plumb_joint_torque(w, j), arm = -(double)d.anchor.x;
        print_message(
            "%-10s at rest: %.5f N, weight %.5f; torque %.5f N m, exact %.5f; error %.2g\n",
            plumb_joint_kind_name(d.kind), (double)f.y, 2 * SIM_G, torque, 2 * SIM_G * arm,
            (double)plumb_joint_error(w, j));
        assert_near(f.y, 2 * SIM_G, 0.02);
        assert_near(f.x, 0, ROUNDED(0.01));
        assert_near(torque, 2 * SIM_G * arm, 0.02);
        assert_true((double)plumb_joint_error(w, j) < 0.001);
        plumb_world_destroy(w);
    }
}

// Period and decay of a spring on a rod without gravity, and how far it gives under a weight.
static void springs_keep_time(void **state)
{
    (void)state;
    const double cases[][2] = { { 1, 0 }, { 1, 0.1 }, { 3, 0.05 }, { 8, 0 } };
    for (size_t k = 0; k < sizeof cases / sizeof cases[0]; ++k) {
        double hertz = cases[k][0], zeta = cases[k][1], omega = 2 * SIM_PI * hertz;
        plumb_world *w = sim_space();
        plumb_body b = sim_mass(w, 2.5, 0, 1, 0);
        plumb_joint j = sim_joint(w, (plumb_joint_desc){ .kind = PLUMB_DISTANCE,
                                                         .body_b = b,
                                                         .anchor_b = sim_vec(2.5, 0),
                                                         .length = 2,
                                                         .hertz = (plumb_real)hertz,
                                                         .damping = (plumb_real)zeta });
        double t = 0, first = 0, at = 0, last = 0.5;
        int crossings = 0;
        for (; crossings < 11; t += DT / 4) {
            sim_step(w, DT / 4);
            double x = sim_x(w, b) - 2;
            if ((x > 0) != (last > 0)) {
                at = t + DT / 4 * last / (last - x);
                first = crossings++ == 0 ? at : first;
            }
            last = x;
        }
        double period = (at - first) / 5, exact = 1 / (hertz * sqrt(1 - zeta * zeta));
        double energy =
            sim_vx(w, b) * sim_vx(w, b) / 2 + omega * omega * pow(value(w, j) - 2, 2) / 2;
        double start = omega * omega * 0.125, damped = start * exp(-2 * zeta * omega * t);
        print_message(
            "spring %g Hz, damping %g: period %.6f s, exact %.6f (%+.3f %%); energy %.4g of "
            "%.4g J, exact %.4g\n",
            hertz, zeta, period, exact, 100 * (period / exact - 1), energy, start, damped);
        assert_near(period / exact, 1, 0.01);
        assert_near(energy, damped, 0.05 * start);
        plumb_world_destroy(w);
    }
    plumb_world *w = sim_world(&(plumb_world_desc){ 0 });
    plumb_body b = sim_mass(w, 0, -2, 3, 0);
    plumb_joint j = sim_joint(w, (plumb_joint_desc){ .kind = PLUMB_DISTANCE,
                                                     .body_b = b,
                                                     .anchor_b = sim_vec(0, -2),
                                                     .hertz = 1,
                                                     .damping = (plumb_real)0.5 });
    sim_run(w, 900, DT);
    double sag = value(w, j) - 2, wanted = SIM_G / (4 * SIM_PI * SIM_PI);
    print_message("spring under a weight: gives %.6f m, exact %.6f\n", sag, wanted);
    assert_near(sag / wanted, 1, 1e-3);
    plumb_world_destroy(w);
}

// Places of a spring let go at 0.2 m, at 60 Hz with 4 substeps; below some bound of stiffness it is exact.
static void springs_follow_their_exponential(void **state)
{
    (void)state;
    const double cases[][2] = { { 20, 0 }, { 1, 0 },   { 5, 0.1 }, { 5, 1 },
                                { 5, 2 },  { 2, 0.5 }, { 3, 20 },  { 5, 0.9999 } };
    const size_t count = sizeof cases / sizeof cases[0];
    for (size_t i = 0; i < 2 * count; ++i) {
        const size_t k = i % count;
        const bool newtons = i >= count; // the same spring, told by stiffness and damper
        const double f = 2 * SIM_PI * cases[k][0], z = cases[k][1], a = 0.2, kg = 3;
        plumb_world *w = sim_world(&(plumb_world_desc){ .zero_gravity = true, .no_sleep = true });
        plumb_body b = sim_mass(w, 2 + a, 0, kg, 0);
        sim_joint(w, (plumb_joint_desc){ .kind = PLUMB_DISTANCE,
                                         .body_b = b,
                                         .anchor_b = sim_vec(2 + a, 0),
                                         .length = 2,
                                         .hertz = (plumb_real)(newtons ? 0 : cases[k][0]),
                                         .damping = (plumb_real)(newtons ? 0 : z),
                                         .stiffness = (plumb_real)(newtons ? kg * f * f : 0),
                                         .damper = (plumb_real)(newtons ? 2 * z * f * kg : 0) });
        double worst = 0;
        for (int n = 1; n <= 180; ++n) {
            sim_step(w, DT);
            const double t = n * DT, q = f * sqrt(fabs(1 - z * z)), left = exp(-z * f * t) / 2;
            const double up = exp((q - z * f) * t) / 2, down = exp(-(q + z * f) * t) / 2;
            const double exact = z < 1   ? 2 * left * (cos(q * t) + z * f / q * sin(q * t))
                                 : z > 1 ? up + down + z * f / q * (up - down)
                                         : 2 * left * (1 + f * t);
            worst = fmax(worst, fabs(sim_x(w, b) - 2 - a * exact));
        }
        print_message("spring %g Hz, damping %g%s: within %.2g m in 3 s\n", cases[k][0], z,
                      newtons ? ", in newtons" : "", worst);
        assert_true(worst < SIM_TOLERANCE(2e-5, 1e-7));
        plumb_world_destroy(w);
    }
}

// [N/m] of a spring of that frequency: a star holds bodies to the world, but for its first spring a row ties two.
static plumb_real stiff_as(double hertz, bool star)
{
    return (plumb_real)(4 * SIM_PI * SIM_PI * hertz * hertz * (star ? 1 : 0.5));
}

// Sixteen springs on one body, and twenty bodies in a row on springs: the farthest that one goes.
static double stretch_network(double hertz, bool star, bool newtons, double *rest)
{
    plumb_world *w = sim_world(&(plumb_world_desc){ .zero_gravity = true, .no_sleep = true });
    const plumb_body none = { { 0, 0 } };
    plumb_body first = none, last = none;
    double farthest = 0;
    for (int i = 0; i < (star ? 16 : 20); ++i) {
        const double angle = 2 * SIM_PI * i / 16, x = star ? 2 * cos(angle) : i;
        plumb_body b = star && i > 0 ? first : sim_mass(w, star ? 0 : i, 0, 1, 0);
        sim_joint(
            w, (plumb_joint_desc){ .kind = PLUMB_DISTANCE,
                                   .body_a = star ? none : last,
                                   .body_b = b,
                                   .anchor = star ? sim_vec(x, 2 * sin(angle)) : sim_vec(i - 1, 0),
                                   .anchor_b = star ? sim_vec(0, 0) : sim_vec(i, 0),
                                   .hertz = (plumb_real)(newtons ? 0 : hertz),
                                   .stiffness = newtons ? stiff_as(hertz, star) : 0 });
        first = i == 0 ? b : first;
        last = b;
    }
    sim_launch(w, last, 0.1, 0, 0);
    const double start = sim_x(w, last);
    for (int i = 0; i < 3600; ++i) {
        sim_step(w, DT);
        farthest = fmax(farthest, fabs(sim_x(w, last) - start));
    }
    *rest = sim_max_speed(w);
    plumb_world_destroy(w);
    return farthest;
}

static void networks_of_springs_gain_nothing(void **state)
{
    (void)state;
    int wrong = 0;
    const double hertz[] = { 1, 5, 10, 15, 20, 25, 30, 35, 40, 60, 120, 1000, 1e5 };
    for (size_t k = 0; k < sizeof hertz / sizeof hertz[0]; ++k) {
        for (int how = 0; how < 4; ++how) {
            const bool star = how % 2 == 1, newtons = how > 1;
            double speed, farthest = stretch_network(hertz[k], star, newtons, &speed);
            print_message("%s of %g Hz%s: %.3g m at most, after 60 s at %.2g m/s\n",
                          star ? "star" : "row", hertz[k], newtons ? " in newtons" : "", farthest,
                          speed);
            // As soft as 20 Hz would be, at least, and 20 times as far in a row.
            const double reach = 0.12 / (2 * SIM_PI * fmin(hertz[k], 20));
            wrong += !(farthest < reach * (star ? 1 : 20) && speed < 0.12);
        }
    }
    assert_int_equal(wrong, 0);
}

// A rotary spring is a revolute joint with hertz: about the joint the inertia is I + m r^2.
static void rotary_spring_keeps_time(void **state)
{
    (void)state;
    plumb_world *w = sim_space();
    plumb_body b = sim_mass(w, 0, 0, 1, 0.5);
    plumb_joint j =
        sim_joint(w, (plumb_joint_desc){ .kind = PLUMB_REVOLUTE, .body_b = b, .hertz = 2 });
    sim_launch(w, b, 0, 0, 1);
    double last = 0, first = -1, at = 0, t = 0;
    int crossings = 0;
    for (; crossings < 10; t += DT) {
        sim_step(w, DT);
        double x = value(w, j);
        if (last < 0 && x >= 0) {
            at = t + DT * last / (last - x);
            first = crossings++ == 0 ? at : first;
        }
        last = x;
    }
    double period = (at - first) / 9;
    print_message("rotary spring 2 Hz: period %.5f s\n", period);
    assert_near(period / 0.5, 1, 0.01);
    plumb_world_destroy(w);
}

// Atwood: a = g (m1 - m2) / (m1 + m2).
static void pulley_falls_as_atwood_says(void **state)
{
    (void)state;
    plumb_world *w = sim_world(&(plumb_world_desc){ 0 });
    plumb_body a = sim_mass(w, -1, -2, 3, 0), b = sim_mass(w, 1, -2, 1, 0);
    plumb_joint j = sim_joint(w, (plumb_joint_desc){ .kind = PLUMB_PULLEY,
                                                     .body_a = a,
                                                     .body_b = b,
                                                     .anchor = sim_vec(-1, -2),
                                                     .anchor_b = sim_vec(1, -2),
                                                     .ground_a = sim_vec(-1, 0),
                                                     .ground_b = sim_vec(1, 0) });
    sim_run(w, 30, DT);
    double accel = -sim_vy(w, a) / 0.5, wanted = SIM_G / 2;
    double pull = (double)plumb_joint_force(w, j).y, tension = 2 * 3 * 1 * SIM_G / 4;
    print_message("pulley: %.5f m/s^2, exact %.5f; rope %.4f N, exact %.4f; length off by %.2g m\n",
                  accel, wanted, pull, tension, value(w, j));
    assert_near(accel / wanted, 1, ROUNDED(1e-3));
    assert_near(pull / tension, 1, ROUNDED(1e-3));
    assert_near(value(w, j), 0, 5e-4);
    plumb_world_destroy(w);
}

static void gears_keep_their_ratio(void **state)
{
    (void)state;
    plumb_world *w = sim_space();
    plumb_body a = sim_mass(w, 0, 0, 1, 1), b = sim_mass(w, 3, 0, 1, 2);
    sim_joint(w, (plumb_joint_desc){ .kind = PLUMB_REVOLUTE, .body_b = a });
    sim_joint(w,
              (plumb_joint_desc){ .kind = PLUMB_REVOLUTE, .body_b = b, .anchor = sim_vec(3, 0) });
    plumb_joint gear = sim_joint(
        w, (plumb_joint_desc){ .kind = PLUMB_GEAR, .body_a = a, .body_b = b, .ratio = 3 });
    sim_launch(w, a, 0, 0, 9);
    sim_run(w, 1200, DT);
    print_message("gear 3:1 after 20 s: speeds %.5f and %.5f rad/s, off by %.2g rad\n", sim_w(w, a),
                  sim_w(w, b), value(w, gear));
    assert_near(sim_w(w, a) + 3 * sim_w(w, b), 0, ROUNDED(1e-3));
    assert_near(value(w, gear), 0, ROUNDED(1e-3));
    // w_a = 9 / (1 + I_b / (I_a n^2)), the energy that the jerk of engaging leaves.
    assert_near(sim_w(w, a) - 9 / (1 + 2.0 / 9), 0, ROUNDED(0.01));
    plumb_world_destroy(w);

    w = sim_space();
    a = sim_mass(w, 0, 0, 1, 1);
    b = sim_mass(w, 0, -1, 2, 1);
    sim_joint(w, (plumb_joint_desc){ .kind = PLUMB_REVOLUTE, .body_b = a });
    sim_joint(w,
              (plumb_joint_desc){ .kind = PLUMB_PRISMATIC, .body_b = b, .anchor = sim_vec(0, -1) });
    gear = sim_joint(
        w, (plumb_joint_desc){
               .kind = PLUMB_GEAR, .body_a = a, .body_b = b, .axis = sim_vec(1, 0), .ratio = -2 });
    sim_launch(w, b, 1, 0, 0);
    sim_run(w, 300, DT);
    print_message("rack: %.5f rad/s, %.5f m/s, off by %.2g\n", sim_w(w, a), sim_vx(w, b),
                  value(w, gear));
    assert_near(sim_w(w, a), 2 * sim_vx(w, b), ROUNDED(1e-3));
    assert_near(value(w, gear), 0, ROUNDED(1e-3));
    plumb_world_destroy(w);
}

// A rack that is held against its weight by a motor: the reaction is its weight at its centre, wherever the machine
// stands, so that what a gear breaks by is its load.
static void a_rack_weighs_the_same_everywhere(void **state)
{
    (void)state;
    for (int i = 0; i < 3; ++i) {
        const double x = 500 * i;
        plumb_world *w = sim_world(&(plumb_world_desc){ 0 });
        plumb_body wheel = sim_mass(w, x, 0, 1, 1), rack = sim_mass(w, x + 1, 0, 2, 1);
        sim_joint(w, (plumb_joint_desc){ .kind = PLUMB_REVOLUTE,
                                         .body_b = wheel,
                                         .anchor = sim_vec(x, 0),
                                         .enable_motor = true,
                                         .motor_speed = 2,
                                         .max_motor = 1000 });
        sim_joint(w, (plumb_joint_desc){ .kind = PLUMB_PRISMATIC,
                                         .body_b = rack,
                                         .anchor = sim_vec(x + 1, 0),
                                         .axis = sim_vec(0, 1) });
        plumb_joint gear = sim_joint(w, (plumb_joint_desc){ .kind = PLUMB_GEAR,
                                                            .body_a = wheel,
                                                            .body_b = rack,
                                                            .axis = sim_vec(0, 1),
                                                            .ratio = -1,
                                                            .break_torque = 1 });
        sim_run(w, 120, DT);
        assert_true(plumb_joint_valid(w, gear));
        assert_near(plumb_joint_force(w, gear).y, 2 * SIM_G, ROUNDED(1e-3));
        assert_near(plumb_joint_torque(w, gear), 0, ROUNDED(1e-3));
        assert_near(plumb_joint_anchor_a(w, gear).x, x, 1e-3);
        assert_near(plumb_joint_anchor_b(w, gear).x, x + 1, 1e-3);
        plumb_world_destroy(w);
    }
}

static void slider_on_an_incline(void **state)
{
    (void)state;
    const double slope = SIM_PI / 6, t = 1;
    plumb_world *w = sim_world(&(plumb_world_desc){ 0 });
    plumb_body b = sim_mass(w, 0, 0, 1, 0.3);
    plumb_joint j = sim_joint(w, (plumb_joint_desc){ .kind = PLUMB_PRISMATIC,
                                                     .body_b = b,
                                                     .axis = sim_vec(-cos(slope), -sin(slope)) });
    sim_run(w, 60, DT);
    double speed = hypot(sim_vx(w, b), sim_vy(w, b)), wanted = SIM_G * sin(slope) * t;
    double push = hypot((double)plumb_joint_force(w, j).x, (double)plumb_joint_force(w, j).y);
    print_message("slider: %.5f m/s, exact %.5f; travel %.4f m; pushed by %.4f N, exact %.4f\n",
                  speed, wanted, value(w, j), push, SIM_G * cos(slope));
    assert_near(speed / wanted, 1, ROUNDED(1e-3));
    assert_near(push / (SIM_G * cos(slope)), 1, ROUNDED(1e-3));
    assert_near(value(w, j) / (wanted * t / 2), 1, 0.01);
    plumb_world_destroy(w);
}

// I dw/dt = T until the speed is there, then it stays.
static void motor_gets_up_to_speed(void **state)
{
    (void)state;
    plumb_world *w = sim_space();
    plumb_body b = sim_mass(w, 0, 0, 1, 2);
    plumb_joint j = sim_joint(w, (plumb_joint_desc){ .kind = PLUMB_REVOLUTE,
                                                     .body_b = b,
                                                     .enable_motor = true,
                                                     .motor_speed = 5,
                                                     .max_motor = 4 });
    sim_run(w, 60, DT);
    double half_way = sim_w(w, b), torque = (double)plumb_joint_torque(w, j);
    sim_run(w, 120, DT);
    print_message("motor: %.5f rad/s after 1 s, exact 2, by %.4f N m; %.5f after 3 s, wanted 5\n",
                  half_way, torque, sim_w(w, b));
    assert_near(half_way, 2, ROUNDED(0.01));
    assert_near(torque, 4, ROUNDED(0.01));
    assert_near(sim_w(w, b), 5, ROUNDED(1e-4));
    plumb_world_destroy(w);
}

static void limits_and_ropes_stop(void **state)
{
    (void)state;
    plumb_world *w = sim_world(&(plumb_world_desc){ 0 });
    plumb_body b = sim_mass(w, 0, -1, 1, 0), rod = sim_mass(w, 6, 0, 1, 0.3);
    plumb_joint rope = sim_joint(w, (plumb_joint_desc){ .kind = PLUMB_DISTANCE,
                                                        .body_b = b,
                                                        .anchor_b = sim_vec(0, -1),
                                                        .enable_limit = true,
                                                        .upper = 2 });
    plumb_joint door = sim_joint(w, (plumb_joint_desc){ .kind = PLUMB_REVOLUTE,
                                                        .body_b = rod,
                                                        .anchor = sim_vec(5, 0),
                                                        .enable_limit = true,
                                                        .lower = (plumb_real)-0.5,
                                                        .upper = (plumb_real)0.5 });
    double longest = 0, farthest = 0;
    for (int i = 0; i < 240; ++i) {
        sim_step(w, DT);
        longest = fmax(longest, value(w, rope));
        farthest = fmin(farthest, value(w, door));
    }
    print_message("rope of 2 m: %.5f m at most; door to -0.5 rad: %.5f at most\n", longest,
                  farthest);
    assert_true(longest < 2.01 && fabs(value(w, rope) - 2) < 1e-3);
    assert_true(farthest > -0.51 && fabs(value(w, door) + 0.5) < 1e-3);
    assert_near((double)plumb_joint_force(w, rope).y, SIM_G, ROUNDED(0.01));
    plumb_world_destroy(w);
}

// Turns freely forwards; backwards, the pawl holds it at a tooth.
static void ratchet_turns_one_way(void **state)
{
    (void)state;
    plumb_world *w = sim_space();
    plumb_body b = sim_mass(w, 0, 0, 1, 1);
    sim_joint(w, (plumb_joint_desc){ .kind = PLUMB_REVOLUTE, .body_b = b });
    plumb_joint j = sim_joint(
        w, (plumb_joint_desc){ .kind = PLUMB_RATCHET, .body_b = b, .pitch = (plumb_real)0.5 });
    sim_launch(w, b, 0, 0, 3);
    sim_run(w, 70, DT);
    double forward = value(w, j);
    sim_launch(w, b, 0, 0, -3);
    sim_run(w, 120, DT);
    print_message("ratchet: forward to %.4f rad, back to %.4f, tooth at 3.5\n", forward,
                  value(w, j));
    assert_near(forward, 3.5, ROUNDED(0.01));
    assert_true(fabs(remainder(value(w, j), 0.5)) < 1e-3 && value(w, j) > 2.99);
    plumb_world_destroy(w);
}

// Dry friction takes force / mass from the speed each second. The exact solver bounds each axis by itself.
static void friction_joint_brakes(void **state)
{
    (void)state;
    for (int solver = PLUMB_SOLVER_SOFT; solver <= PLUMB_SOLVER_EXACT; ++solver) {
        const bool aslant = solver != PLUMB_SOLVER_EXACT;
        plumb_world *w =
            sim_world(&(plumb_world_desc){ .zero_gravity = true, .solver = (plumb_solver)solver });
        plumb_body b = sim_mass(w, 0, 0, 2, 1);
        sim_joint(w, (plumb_joint_desc){
                         .kind = PLUMB_FRICTION, .body_b = b, .max_force = 2, .max_torque = 1 });
        sim_launch(w, b, aslant ? 3 : 0, aslant ? 4 : 5, 2);
        sim_run(w, 60, DT);
        const double v = hypot(sim_vx(w, b), sim_vy(w, b));
        print_message("friction: %.5f m/s, exact 4; %.5f rad/s, exact 1\n", v, sim_w(w, b));
        assert_near(v, 4, ROUNDED(0.01));
        assert_near(sim_w(w, b), 1, ROUNDED(0.01));
        plumb_world_destroy(w);
    }
}

// A suspension gives by g / w^2 and the wheel turns freely.
static void wheel_rests_on_its_spring(void **state)
{
    (void)state;
    plumb_world *w = sim_world(&(plumb_world_desc){ 0 });
    plumb_body b = sim_mass(w, 0, 0, 1, 1);
    plumb_joint j = sim_joint(
        w, (plumb_joint_desc){ .kind = PLUMB_WHEEL, .body_b = b, .hertz = 2, .damping = 1 });
    sim_launch(w, b, 0, 0, 3);
    sim_run(w, 600, DT);
    double wanted = -SIM_G / pow(4 * SIM_PI, 2);
    print_message("wheel: gives %.6f m, exact %.6f; turns at %.6f rad/s\n", value(w, j), wanted,
                  sim_w(w, b));
    assert_near(value(w, j) / wanted, 1, ROUNDED(1e-3));
    assert_near(sim_w(w, b), 3, ROUNDED(1e-4));
    plumb_world_destroy(w);
}

// The classic solver knows joints as well.
static void classic_solver_holds_joints(void **state)
{
    (void)state;
    plumb_world *w = sim_world(&(plumb_world_desc){ .solver = PLUMB_SOLVER_PGS });
    plumb_body a = sim_mass(w, 1, 0, 1, 0.1), b = sim_mass(w, 2, 0, 1, 0.1);
    plumb_joint j = sim_joint(w, (plumb_joint_desc){ .kind = PLUMB_REVOLUTE, .body_b = a });
    plumb_joint k = sim_joint(
        w, (plumb_joint_desc){ .kind = PLUMB_WELD, .body_a = a, .body_b = b, .anchor = { 1, 0 } });
    double worst = 0;
    for (int i = 0; i < 300; ++i) {
        sim_step(w, DT);
        worst = fmax(worst, (double)(plumb_joint_error(w, j) + plumb_joint_error(w, k)));
    }
    print_message("classic solver: two joints off by %.3g m at most\n", worst);
    assert_true(worst < 0.1);
    plumb_world_destroy(w);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(pendulum_keeps_period_and_amplitude),
        cmocka_unit_test(rod_pulls_at_its_hinge),
        cmocka_unit_test(spinning_rod_keeps_its_spin),
        cmocka_unit_test(reactions_at_rest_are_the_weight),
        cmocka_unit_test(springs_keep_time),
        cmocka_unit_test(springs_follow_their_exponential),
        cmocka_unit_test(networks_of_springs_gain_nothing),
        cmocka_unit_test(rotary_spring_keeps_time),
        cmocka_unit_test(pulley_falls_as_atwood_says),
        cmocka_unit_test(gears_keep_their_ratio),
        cmocka_unit_test(a_rack_weighs_the_same_everywhere),
        cmocka_unit_test(slider_on_an_incline),
        cmocka_unit_test(motor_gets_up_to_speed),
        cmocka_unit_test(limits_and_ropes_stop),
        cmocka_unit_test(ratchet_turns_one_way),
        cmocka_unit_test(friction_joint_brakes),
        cmocka_unit_test(wheel_rests_on_its_spring),
        cmocka_unit_test(classic_solver_holds_joints),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
