// test_drag.c - drag of still air: closed forms of what slows down and falls, with linear and quadratic drag and both; the order
// of all other motion; who pays.
//
// Alone, dv/dt = -c v - k v^2:  v = v0 E / (1 + k v0 (1 - E) / c), E = exp(-c t); with c = 0 v0 / (1 + k v0 t). From rest under g,
// with s = sqrt(c^2 + 4 k g) and T = tanh(s t / 2):  v = 2 g T / (s + c T)  (Riccati's equation).
#include "harness/near.h"
#include "harness/sim.h"

#include <math.h>
#include <setjmp.h>
#include <stdio.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#define R(x) ((plumb_real)(x))

static plumb_body make(plumb_world *w, double c, double drag, double mass, double vx, double vy)
{
    return plumb_body_create(w, &(plumb_body_desc){ .mass = R(mass),
                                                    .damping = R(c),
                                                    .drag = R(drag),
                                                    .velocity = { R(vx), R(vy) },
                                                    .no_sleep = true });
}

typedef struct law {
    double c, drag, mass;
} law;

static const law laws[] = { { 0, 0.02, 1 }, { 0, 3, 0.5 }, { 0.3, 0, 2 },   { 0.3, 0.02, 2 },
                            { 5, 40, 0.1 }, { 60, 1, 1 },  { 0.01, 500, 1 } };
enum { LAWS = sizeof laws / sizeof laws[0] };

static double slowed(const law *l, double v, double t)
{
    const double k = l->drag / l->mass, mean = l->c > 0 ? (1 - exp(-l->c * t)) / l->c : t;
    return v * exp(-l->c * t) / (1 + k * v * mean);
}

static double fallen(const law *l, double g, double t)
{
    const double k = l->drag / l->mass, s = sqrt(l->c * l->c + 4 * k * g), T = tanh(s * t / 2);
    return 2 * g * T / (s + l->c * T);
}

// Whatever the step, from a hundredth of a second to a quarter.
static void test_slows_down_alone(void **state)
{
    (void)state;
    for (int i = 0; i < LAWS; ++i) {
        for (int n = 8; n <= 200; n *= 5) {
            plumb_world *w = sim_space();
            const plumb_body b = make(w, laws[i].c, laws[i].drag, laws[i].mass, 18, -24);
            double worst = 0;
            for (int k = 1; k <= n; ++k) {
                sim_step(w, 2.0 / n);
                // A step that takes nearly all of a speed rounds by that speed: 1 % of the first one counts as well.
                const double want = slowed(&laws[i], 30, 2.0 * k / n);
                const double off = hypot(sim_vx(w, b), sim_vy(w, b)) - want;
                worst = fmax(worst, fabs(off) / (want + 0.3));
            }
            printf("c %g drag %g steps %d: off by %.2e of it\n", laws[i].c, laws[i].drag, n, worst);
            assert_near(worst, 0, ROUNDED(2e-5));
            plumb_world_destroy(w);
        }
    }
}

static void test_falls_from_rest(void **state)
{
    (void)state;
    for (int i = 0; i < LAWS; ++i) {
        for (int n = 8; n <= 200; n *= 5) {
            plumb_world *w = sim_world(&(plumb_world_desc){ 0 });
            const plumb_body b = make(w, laws[i].c, laws[i].drag, laws[i].mass, 0, 0);
            double worst = 0;
            for (int k = 1; k <= n; ++k) {
                sim_step(w, 2.0 / n);
                const double want = fallen(&laws[i], SIM_G, 2.0 * k / n);
                worst = fmax(worst, fabs(-sim_vy(w, b) - want) / want);
            }
            printf("c %g drag %g steps %d: off by %.2e of it\n", laws[i].c, laws[i].drag, n, worst);
            assert_near(worst, 0, ROUNDED(2e-5));
            plumb_world_destroy(w);
        }
    }
}

// c v + k v^2 = g, along any direction of gravity and from either side, with steps that are far too long.
static void test_terminal_speed(void **state)
{
    (void)state;
    for (int i = 0; i < LAWS; ++i) {
        const law *l = &laws[i];
        const double k = l->drag / l->mass;
        const double s = sqrt(l->c * l->c + 4 * k * SIM_G), top = 2 * SIM_G / (l->c + s);
        plumb_world *w =
            sim_world(&(plumb_world_desc){ .gravity = { R(-0.6 * SIM_G), R(0.8 * SIM_G) } });
        const plumb_body b = make(w, l->c, l->drag, l->mass, 3, 20);
        sim_run(w, 400, 0.25);
        assert_near(sim_vx(w, b) / (-0.6 * top), 1, ROUNDED(2e-6));
        assert_near(sim_vy(w, b) / (0.8 * top), 1, ROUNDED(2e-6));
        plumb_world_destroy(w);
    }
}

// A shot through the air by classical Runge-Kutta, in steps too small to matter.
static void shoot(double c, double k, double out[2])
{
    double y[4] = { 0, 0, 20, 25 };
    enum { STEPS = 20000 };
    const double h = 3.0 / STEPS;
    for (int i = 0; i < STEPS; ++i) {
        double sum[4] = { 0 }, d[4] = { 0 };
        const double at[] = { 0, 0.5, 0.5, 1 }, weight[] = { 1.0 / 6, 1.0 / 3, 1.0 / 3, 1.0 / 6 };
        for (int stage = 0; stage < 4; ++stage) {
            double z[4];
            for (int j = 0; j < 4; ++j) {
                z[j] = y[j] + at[stage] * h * d[j];
            }
            const double slow = c + k * hypot(z[2], z[3]);
            d[0] = z[2], d[1] = z[3], d[2] = -slow * z[2], d[3] = -SIM_G - slow * z[3];
            for (int j = 0; j < 4; ++j) {
                sum[j] += weight[stage] * d[j];
            }
        }
        for (int j = 0; j < 4; ++j) {
            y[j] += h * sum[j];
        }
    }
    out[0] = y[0], out[1] = y[1];
}

static void test_order_of_a_shot(void **state)
{
    (void)state;
    for (int linear = 0; linear < 2; ++linear) {
        double want[2], error[4];
        shoot(0.4 * linear, 0.05, want);
        for (int i = 0; i < 4; ++i) {
            const int n = 10 << i;
            plumb_world *w = sim_world(&(plumb_world_desc){ 0 });
            const plumb_body b = make(w, 0.4 * linear, 0.1, 2, 20, 25);
            sim_run(w, n, 3.0 / n);
            error[i] = hypot(sim_x(w, b) - want[0], sim_y(w, b) - want[1]);
            printf("shot, %d steps: off by %.3e m\n", n, error[i]);
            plumb_world_destroy(w);
        }
        printf("order %.2f\n", sim_order(error, 4));
        assert_near(sim_order(error, 4), 2, 0.15);
    }
}

// In time of its own a body goes through the same path; along a rail that leaves one axis free, as along a line.
static void test_own_time_and_rails(void **state)
{
    (void)state;
    plumb_world *w = sim_space();
    const law l = { 0.5, 0.3, 1.5 };
    const plumb_body slow = make(w, l.c, l.drag, l.mass, 10, 0),
                     rail = make(w, l.c, l.drag, l.mass, 10, 0),
                     still = make(w, l.c, l.drag, l.mass, 10, 0);
    plumb_body_set_time_scale(w, slow, R(0.5));
    plumb_body_set_time_scale(w, still, 0);
    plumb_body_set_locks(w, rail, (plumb_axis_locks){ .y = true });
    sim_run(w, 120, 1.0 / 60);
    assert_near(sim_vx(w, slow), slowed(&l, 10, 1), ROUNDED(2e-5));
    assert_near(sim_vx(w, rail), slowed(&l, 10, 2), ROUNDED(2e-5));
    assert_near(sim_vx(w, still), 10, 0);
    assert_near(sim_y(w, rail), 0, 0);
    plumb_world_destroy(w);
}

// The spin is damping's alone.
static void test_spin(void **state)
{
    (void)state;
    plumb_world *w = sim_space();
    const plumb_body b = plumb_body_create(w, &(plumb_body_desc){ .mass = 1,
                                                                  .inertia = 1,
                                                                  .drag = 5,
                                                                  .angular_damping = R(0.7),
                                                                  .velocity = { 4, 0 },
                                                                  .angular_velocity = 3 });
    sim_run(w, 60, 1.0 / 60);
    assert_near(sim_w(w, b), 3 * exp(-0.7), ROUNDED(2e-5));
    assert_near(sim_vx(w, b), 4 / (1 + 5 * 4.0), ROUNDED(2e-5));
    plumb_world_destroy(w);
}

// What drag takes is what is missing, and nothing else.
static void test_energy(void **state)
{
    (void)state;
    plumb_world *w = sim_world(&(plumb_world_desc){ .measure = true });
    const plumb_body b = make(w, 0.2, 0.1, 2, 20, 25);
    double taken = 0;
    const double before = sim_energy(w);
    for (int i = 0; i < 120; ++i) {
        sim_step(w, 1.0 / 60);
        const plumb_measures m = *plumb_world_measures(w);
        taken += (double)m.work[PLUMB_WORK_DAMPING].kinetic;
        assert_near((double)m.work[PLUMB_WORK_FORCES].kinetic, 0, ROUNDED(1e-2));
        assert_true((double)m.work[PLUMB_WORK_DAMPING].kinetic < 0);
    }
    printf("drag took %.3f J of %.3f J\n", -taken, before);
    assert_near(sim_energy(w) - before, taken, ROUNDED(2e-1));
    assert_true(plumb_body_valid(w, b));
    plumb_world_destroy(w);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_slows_down_alone),
        cmocka_unit_test(test_falls_from_rest),
        cmocka_unit_test(test_terminal_speed),
        cmocka_unit_test(test_order_of_a_shot),
        cmocka_unit_test(test_own_time_and_rails),
        cmocka_unit_test(test_spin),
        cmocka_unit_test(test_energy),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
