// test_engine.c - engines that burn fuel: the rocket equation, whatever the step; places of second order; what ends within a step;
// momentum with the exhaust; weight, torque, joints, and what burns nothing.
#include "harness/near.h"
#include "harness/sim.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <cmocka.h>

#define R(x) ((plumb_real)(x))

// 10 kg, 8 of them fuel: 4 s of 200 N at 100 m/s.
static plumb_body rocket(plumb_world *w, plumb_body_desc d)
{
    d.mass = 10, d.inertia = 5, d.fuel = 8, d.thrust = 200, d.exhaust = 100;
    return plumb_body_create(w, &d);
}

static double mass_at(double t)
{
    return t < 4 ? 10 - 2 * t : 2;
}

// Of the rocket from rest: x = u (t - (m / r) ln(m0 / m)), r the mass flow, then evenly on.
static double way_at(double t)
{
    const double burns = t < 4 ? t : 4, m = mass_at(t);
    return 100 * (burns - m / 2 * log(10 / m)) + (t - burns) * 100 * log(5.0);
}

static void test_rocket_equation(void **state)
{
    (void)state;
    double error[5];
    for (int k = 0; k < 5; ++k) {
        const int n = 7 << k; // no step ends with the fuel
        plumb_world *w = sim_space();
        const plumb_body b = rocket(w, (plumb_body_desc){ 0 });
        double worst = 0, left = 0;
        for (int i = 1; i <= n; ++i) {
            sim_step(w, 5.0 / n);
            const double m = mass_at(5.0 * i / n);
            worst = fmax(worst, fabs(sim_vx(w, b) / (100 * log(10 / m)) - 1));
            left = fmax(left, fabs((double)plumb_body_mass(w, b) - m));
        }
        error[k] = fabs(sim_x(w, b) - way_at(5));
        printf("%d steps: speed off by %.1e of it, mass %.1e kg, place %.2e m\n", n, worst, left,
               error[k]);
        assert_near(worst, 0, ROUNDED(1e-5));
        assert_near(left, 0, ROUNDED(1e-5));
        assert_near((double)plumb_body_fuel(w, b), 0, 0);
        assert_near((double)plumb_body_inertia(w, b), 1, ROUNDED(1e-5));
        plumb_world_destroy(w);
    }
    printf("order %.2f\n", sim_order(error, 5));
    assert_true(sim_order(error, 5) > 1.8);
}

// Rocket and exhaust: of each step the exhaust has (v - u) dm, with v as the rocket equation has it.
static void test_momentum_is_kept(void **state)
{
    (void)state;
    plumb_world *w = sim_space();
    const plumb_body b = rocket(w, (plumb_body_desc){ .velocity = { 3, 0 } });
    double gone = 0;
    for (int i = 0; i < 300; ++i) {
        const double m0 = (double)plumb_body_mass(w, b), v0 = sim_vx(w, b);
        sim_step(w, 1.0 / 60);
        const double m1 = (double)plumb_body_mass(w, b);
        gone += m0 > m1 ? (m0 - m1) * (v0 - 100) + 100 * (m0 - m1 - m1 * log(m0 / m1)) : 0;
    }
    assert_near((double)plumb_body_mass(w, b), 2, ROUNDED(1e-5));
    assert_near(gone + 2 * sim_vx(w, b), 30, ROUNDED(5e-2));
    plumb_world_destroy(w);
}

// A gram a step of ten tons, which a real of six digits does not see.
static void test_small_flows_add_up(void **state)
{
    (void)state;
    plumb_world *w = sim_space();
    const plumb_body b = plumb_body_create(
        w, &(plumb_body_desc){ .mass = 10000, .fuel = 9000, .thrust = R(0.06), .exhaust = 1 });
    sim_run(w, 6000, 1.0 / 60);
    assert_near((double)plumb_body_mass(w, b), 9994, 1e-3);
    assert_near((double)plumb_body_fuel(w, b), 8994, 1e-3);
    plumb_world_destroy(w);
}

// Upwards against gravity: v = u ln(m0 / m1) - g t. On the ground it stands until its weight is less than its thrust.
static void test_gravity(void **state)
{
    (void)state;
    plumb_world *w = sim_world(&(plumb_world_desc){ 0 });
    const plumb_body b = rocket(w, (plumb_body_desc){ .thrust_angle = R(SIM_PI / 2) });
    sim_run(w, 180, 1.0 / 60);
    assert_near(sim_vy(w, b), 100 * log(10.0 / 4) - SIM_G * 3, ROUNDED(2e-3));
    plumb_world_destroy(w);
}

// A weak engine on the ground keeps its body awake; when the fuel is out it falls asleep. With all solvers.
static void test_sleep(void **state)
{
    (void)state;
    for (int solver = PLUMB_SOLVER_SOFT; solver <= PLUMB_SOLVER_EXACT; ++solver) {
        plumb_world *w = sim_world(&(plumb_world_desc){ .solver = (plumb_solver)solver });
        const plumb_material m = sim_material(w, 0.5, 0);
        sim_floor(w, m);
        const plumb_body b = sim_crate(w, 0, 0.5, 0.5, 0.5, m);
        plumb_body_set_mass(w, b, 10);
        plumb_body_set_thrust(w, b, 20);
        plumb_body_set_exhaust(w, b, 20);
        plumb_body_set_fuel(w, b, 3);
        sim_run(w, 170, 1.0 / 60);
        assert_true(plumb_body_is_awake(w, b));
        sim_run(w, 200, 1.0 / 60);
        assert_false(plumb_body_is_awake(w, b));
        assert_near((double)plumb_body_mass(w, b), 7, ROUNDED(1e-5));
        assert_near(sim_y(w, b), 0.5, 0.01);
        plumb_world_destroy(w);
    }
}

// A tank welded to a rocket goes with it: u ln((m0 + tank) / (m1 + tank)), to second order where the mean of masses counts.
static void test_welded_tank(void **state)
{
    (void)state;
    for (int solver = PLUMB_SOLVER_SOFT; solver <= PLUMB_SOLVER_EXACT; ++solver) {
        plumb_world *w =
            sim_world(&(plumb_world_desc){ .zero_gravity = true, .solver = (plumb_solver)solver });
        const plumb_body b = rocket(w, (plumb_body_desc){ 0 });
        const plumb_body tank = sim_mass(w, -1, 0, 5, 3);
        sim_joint(w, (plumb_joint_desc){ .kind = PLUMB_WELD, .body_a = b, .body_b = tank });
        sim_run(w, 300, 1.0 / 60);
        const double want = 100 * log(15.0 / 7);
        printf("solver %d: %.6f m/s, want %.6f\n", solver, sim_vx(w, tank), want);
        assert_near(sim_vx(w, tank) / want, 1, solver == PLUMB_SOLVER_PGS ? 1e-3 : 2e-4);
        plumb_world_destroy(w);
    }
}

// Off the centre it turns the body: w = (arm m / I) u ln(m0 / m1), and turns with it.
static void test_torque(void **state)
{
    (void)state;
    plumb_world *w = sim_space();
    const plumb_body b =
        rocket(w, (plumb_body_desc){ .thrust_x = R(-1), .thrust_angle = R(SIM_PI / 2) });
    plumb_body_set_thrust(w, b, 2);
    sim_run(w, 120, 1.0 / 60);
    const double m = 10 - 0.02 * 2;
    assert_near(sim_w(w, b), -2 * 100 * log(10 / m), ROUNDED(2e-5));
    plumb_world_destroy(w);
}

// Throttled by the user; without an exhaust speed it burns nothing; in time of its own it burns by that.
static void test_throttle_and_thrusters(void **state)
{
    (void)state;
    plumb_world *w = sim_space();
    const plumb_body b = rocket(w, (plumb_body_desc){ 0 }),
                     slow = rocket(w, (plumb_body_desc){ .time_scale = R(0.5) });
    const plumb_body ever = plumb_body_create(w, &(plumb_body_desc){ .mass = 2, .thrust = 3 });
    const plumb_body bare =
        plumb_body_create(w, &(plumb_body_desc){ .mass = 2, .thrust = 3, .exhaust = 9 });
    const plumb_body full =
        plumb_body_create(w, &(plumb_body_desc){ .mass = 2, .thrust = 3, .exhaust = 9, .fuel = 2 });
    sim_run(w, 60, 1.0 / 60);
    plumb_body_set_thrust(w, b, 50);
    sim_run(w, 60, 1.0 / 60);
    assert_near((double)plumb_body_mass(w, b), 7.5, ROUNDED(1e-5));
    assert_near(sim_vx(w, b), 100 * log(10 / 7.5), ROUNDED(3e-4));
    assert_near((double)plumb_body_mass(w, slow), 8, ROUNDED(1e-5));
    assert_near(sim_vx(w, slow), 100 * log(10 / 8.0), ROUNDED(3e-4));
    assert_near(sim_vx(w, ever), 3, ROUNDED(3e-5));
    assert_near(sim_vx(w, bare), 0, 0);
    assert_near(sim_vx(w, full), 0, 0);
    plumb_world_destroy(w);
}

// A world that measures knows where the energy comes from, and what leaves with the exhaust.
static void test_energy(void **state)
{
    (void)state;
    plumb_world *w = sim_world(&(plumb_world_desc){ .measure = true });
    rocket(w, (plumb_body_desc){ .thrust_angle = R(1) });
    double known = 0;
    const double before = sim_energy(w);
    for (int i = 0; i < 300; ++i) {
        sim_step(w, 1.0 / 60);
        const plumb_measures m = *plumb_world_measures(w);
        for (int k = 0; k < PLUMB_WORKS; ++k) {
            known += (double)m.work[k].kinetic + (double)m.work[k].potential;
        }
    }
    printf("energy %.1f J, known %.1f J\n", sim_energy(w) - before, known);
    assert_near((known - (sim_energy(w) - before)) / known, 0, ROUNDED(1e-3));
    plumb_world_destroy(w);
}

// An image taken while it burns goes on with the same bits.
static void test_image(void **state)
{
    (void)state;
    plumb_world *w = sim_world(&(plumb_world_desc){ 0 });
    rocket(w, (plumb_body_desc){ .thrust_angle = R(1.2), .drag = R(0.01) });
    sim_run(w, 100, 1.0 / 60);
    const size_t size = plumb_world_snapshot_size(w);
    void *image = malloc(size);
    assert_int_equal(plumb_world_save(w, image, size), PLUMB_OK);
    sim_run(w, 200, 1.0 / 60);
    const uint64_t hash = plumb_world_hash(w);
    assert_int_equal(plumb_world_restore(w, image, size), PLUMB_OK);
    sim_run(w, 200, 1.0 / 60);
    assert_true(plumb_world_hash(w) == hash);
    free(image);
    plumb_world_destroy(w);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_rocket_equation),
        cmocka_unit_test(test_momentum_is_kept),
        cmocka_unit_test(test_small_flows_add_up),
        cmocka_unit_test(test_gravity),
        cmocka_unit_test(test_sleep),
        cmocka_unit_test(test_welded_tank),
        cmocka_unit_test(test_torque),
        cmocka_unit_test(test_throttle_and_thrusters),
        cmocka_unit_test(test_energy),
        cmocka_unit_test(test_image),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
