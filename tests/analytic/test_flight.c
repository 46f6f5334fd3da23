// test_flight.c - motion without contact: projectile, spin, steady force, and what a world full of
// collisions must conserve. Closed forms: textbook mechanics. Error bounds follow from rounding.
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "harness/near.h"
#include "harness/sim.h"

// What rounding alone can do to n steps of x += dt (v + a dt / 2), v += a dt: half a spacing of the
// largest position a step, half a spacing of the largest velocity a step carried on for the
// rest of the way, and two roundings of each increment.
static double flight_bound(int n, double dt, double largest_x, double largest_v)
{
    double steps = n;
    return SIM_EPSILON * (steps * largest_x / 2 + dt * steps * steps * largest_v / 4 +
                          2 * steps * dt * largest_v);
}

typedef struct flight_case {
    const char *name;
    double rate; // [1/s]
    double seconds;
    double vx, vy;
    bool company; // another shape far off puts collision passes in the schedule
} flight_case;

static void projectile_is_exact_to_rounding(void **state)
{
    (void)state;
    const flight_case cases[] = {
        { "60 Hz, alone", 60, 2, 3, 4, false },    { "60 Hz, in company", 60, 2, 3, 4, true },
        { "30 Hz, upwards", 30, 3, -7, 18, true }, { "10 Hz, coarse", 10, 2, 1, 9, false },
        { "240 Hz", 240, 2, 5, 9, true },
    };
    for (size_t k = 0; k < sizeof cases / sizeof cases[0]; ++k) {
        const flight_case *c = &cases[k];
        plumb_world *w = sim_world(&(plumb_world_desc){ 0 });
        plumb_material m = sim_material(w, 0.5, 0.5);
        plumb_body b = sim_ball(w, 0, 10, 0.5, m);
        if (c->company) {
            sim_crate(w, 500, 0, 0.5, 0.5, m);
        }
        sim_launch(w, b, c->vx, c->vy, 0);
        const double dt = (double)(plumb_real)(1 / c->rate);
        const double g = (double)plumb_world_gravity(w).y;
        int n = (int)lround(c->seconds * c->rate);
        double worst = 0, farthest = 0, fastest = 0;
        for (int i = 1; i <= n; ++i) {
            sim_step(w, dt);
            double t = i * dt;
            double x = c->vx * t;
            double y = 10 + c->vy * t + g * t * t / 2;
            worst = fmax(worst, hypot(sim_x(w, b) - x, sim_y(w, b) - y));
            farthest = fmax(farthest, hypot(x, y));
            fastest = fmax(fastest, hypot(c->vx, c->vy + g * t));
        }
        double bound = fmin(flight_bound(n, dt, farthest, fastest), SIM_TOLERANCE(1, 1e-11));
        print_message("projectile, %-20s error %.3g m, bound %.3g m\n", c->name, worst, bound);
        assert_true(worst <= bound);
        plumb_world_destroy(w);
    }
}

// Each step rounds its way, dt v; adding the ways up loses nothing, as what rounding takes from a place is
// carried on. So the error is a rounding of the whole way and of the place, whatever the number of steps. The
// double build carries nothing on: half a rounding of the place a step.
static void gliding_adds_up_without_loss(void **state)
{
    (void)state;
    const double starts[] = { 0, 1000, -1e6 };
    for (size_t k = 0; k < sizeof starts / sizeof starts[0]; ++k) {
        plumb_world *w = sim_space();
        plumb_body b = sim_ball(w, starts[k], 0, 0.5, (plumb_material)PLUMB_NULL_INIT);
        const double dt = (double)(plumb_real)(1 / 60.0), v = (double)(plumb_real)0.1;
        const int n = 100000;
        sim_launch(w, b, v, 0, 0);
        sim_run(w, n, dt);
        const double way = n * dt * v, place = starts[k] + way;
        const bool carries = SIM_IS_FLOAT; // or far
        const double roundings = carries ? 1 : n / 2.0;
        const double largest = fmax(fabs(starts[k]), fabs(place));
        const double bound = (double)PLUMB_REAL_EPSILON * (way + roundings * largest);
        const double error = fabs(sim_x(w, b) - place);
        print_message("gliding from %g m: error %.3g m, bound %.3g m\n", starts[k], error, bound);
        assert_true(error <= bound);
        plumb_world_destroy(w);
    }
}

// A disc with its shape off the origin, so that the frame turns about a centre that is elsewhere.
static void spin_without_torque_is_exact(void **state)
{
    (void)state;
    const double spins[] = { 0.5, 5, 50, -300 };
    for (size_t k = 0; k < sizeof spins / sizeof spins[0]; ++k) {
        plumb_world *w = sim_space();
        plumb_body b = sim_body(w, PLUMB_DYNAMIC, 0, 0, 0);
        plumb_shape_desc off = { .kind = PLUMB_BOX, .half = sim_vec(0.5, 0.1) };
        off.center = sim_vec(1, 0);
        assert_false(plumb_is_null(plumb_shape_create(w, b, &off)));
        sim_launch(w, b, 1, 0, spins[k]);
        const double dt = (double)(plumb_real)(1 / 60.0);
        int n = 600;
        sim_run(w, n, dt);
        double turned = (double)sim_w(w, b) * n * dt;
        // Each step rounds an increment and turns (c, s) by products of rounded numbers.
        double bound = 4 * SIM_EPSILON * n + SIM_EPSILON * fabs(spins[k]) * dt * n;
        double error = fabs(remainder(sim_angle(w, b) - turned, 2 * SIM_PI));
        plumb_vec2 center = plumb_body_center(w, b);
        print_message("spin %6.1f rad/s: angle off by %.3g rad in 10 s, bound %.3g\n", spins[k],
                      error, bound);
        assert_near(sim_w(w, b), spins[k], 0);
        assert_true(error <= bound);
        // The centre of mass flies straight.
        assert_near((double)center.x - (1 + n * dt), 0, n * SIM_EPSILON * 11);
        assert_near(center.y, 0, n * SIM_EPSILON * 2);
        plumb_world_destroy(w);
    }
}

static void steady_force_and_torque_are_exact(void **state)
{
    (void)state;
    plumb_world *w = sim_space();
    plumb_body b = sim_crate(w, 0, 0, 0.5, 0.5, (plumb_material)PLUMB_NULL_INIT);
    const double dt = (double)(plumb_real)(1 / 60.0);
    const double mass = (double)plumb_body_mass(w, b), inertia = (double)plumb_body_inertia(w, b);
    int n = 120;
    for (int i = 0; i < n; ++i) {
        assert_int_equal(plumb_body_apply_force_center(w, b, sim_vec(3, -2)), PLUMB_OK);
        assert_int_equal(plumb_body_apply_torque(w, b, (plumb_real)0.25), PLUMB_OK);
        sim_step(w, dt);
    }
    double t = n * dt;
    double bound = flight_bound(n, dt, 6, 6);
    assert_near(sim_x(w, b), 3 / mass * t * t / 2, bound);
    assert_near(sim_y(w, b) + 2 / mass * t * t / 2, 0, bound);
    double angle = remainder(sim_angle(w, b) - 0.25 / inertia * t * t / 2, 2 * SIM_PI);
    assert_near(angle, 0, bound + 4 * SIM_EPSILON * n);
    plumb_world_destroy(w);
}

typedef struct melee_case {
    double friction, restitution;
    double least_energy; // [-] of the energy at the start that must be left
} melee_case;

// A hundred discs and boxes of many sizes fly inwards and hit one another in empty space. Every
// contact impulse acts on both bodies at one point, so linear momentum keeps to rounding. Anchors
// are frozen for a step while the bodies slip past each other, which costs angular momentum in
// proportion to the slip within a step: first order.
static void melee_conserves_momentum(void **state)
{
    (void)state;
    const melee_case cases[] = { { 0.5, 0, 0 }, { 0.5, 0.5, 0 }, { 0.5, 1, 0 }, { 0, 1, 0.98 } };
    for (size_t k = 0; k < sizeof cases / sizeof cases[0]; ++k) {
        const melee_case *c = &cases[k];
        plumb_world *w = sim_world(&(plumb_world_desc){ .zero_gravity = true, .no_sleep = true });
        plumb_material m = sim_material(w, c->friction, c->restitution);
        unsigned seed = 12345;
        double scale = 0, spin = 0;
        for (int i = 0; i < 100; ++i) {
            double x = (i % 10 - 4.5) * 1.2, y = (i / 10 - 4.5) * 1.2;
            double r = sim_uniform(&seed, 0.2, 0.5);
            plumb_body b = i % 2 ? sim_ball(w, x, y, r, m) : sim_crate(w, x, y, r, r * 0.6, m);
            double vx = sim_uniform(&seed, -1, 1) - x, vy = sim_uniform(&seed, -1, 1) - y;
            sim_launch(w, b, vx, vy, sim_uniform(&seed, -3, 3));
            double p = (double)plumb_body_mass(w, b) * hypot(vx, vy);
            scale += p;
            spin += p * hypot(x, y);
        }
        plumb_energy before = plumb_world_energy(w);
        int impacts = 0;
        int steps = 240;
        for (int i = 0; i < steps; ++i) {
            sim_step(w, 1 / 60.0);
            int begun = 0;
            (void)plumb_world_begin_events(w, &begun);
            impacts += begun;
        }
        plumb_energy after = plumb_world_energy(w);
        double dp =
            hypot(after.momentum_x - before.momentum_x, after.momentum_y - before.momentum_y);
        double dl = fabs(after.angular_momentum - before.angular_momentum);
        print_message("melee mu = %.1f, e = %.1f: %d impacts, momentum off by %.2g of %.3g, "
                      "angular by %.2g of %.3g; energy %.4g -> %.4g\n",
                      c->friction, c->restitution, impacts, dp, scale, dl, spin, before.kinetic,
                      after.kinetic);
        assert_true(impacts > 100);
        // A few roundings of each body's momentum a substep, adding up like a random walk.
        double bound = SIM_EPSILON * sqrt(steps * 4.0) * 4;
        assert_true(dp <= bound * scale);
        assert_true(dl <= 0.01 * spin);
        assert_true(after.kinetic <= before.kinetic * (1 + 1e-3));
        assert_true(after.kinetic >= before.kinetic * c->least_energy);
        plumb_world_destroy(w);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(projectile_is_exact_to_rounding),
        cmocka_unit_test(gliding_adds_up_without_loss),
        cmocka_unit_test(spin_without_torque_is_exact),
        cmocka_unit_test(steady_force_and_torque_are_exact),
        cmocka_unit_test(melee_conserves_momentum),
    };
    return cmocka_run_group_tests_name("flight", tests, NULL, NULL);
}
