// test_energy.c - what plumb_world_energy says of springs, against k x^2 / 2.
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "harness/near.h"
#include "harness/sim.h"

#define HERTZ 2.0
#define OMEGA (2 * SIM_PI * HERTZ)

static plumb_joint tie(plumb_world *w, plumb_joint_desc desc)
{
    desc.hertz = (plumb_real)HERTZ;
    return sim_joint(w, desc);
}

static double stored(const plumb_world *w)
{
    return plumb_world_energy(w).stored;
}

// Against w^2 m x^2 / 2 with the mass that the spring meets.
static void check(const plumb_world *w, double kg, double x)
{
    const double exact = OMEGA * OMEGA * kg * x * x / 2;
    assert_near(stored(w) / exact, 1, ROUNDED(1e-4));
}

static void distance_springs_meet_the_reduced_mass(void **state)
{
    (void)state;
    plumb_world *w = sim_space();
    plumb_body a = sim_mass(w, 0, 0, 2, 0), b = sim_mass(w, 3, 0, 6, 0);
    plumb_joint j = tie(
        w,
        (plumb_joint_desc){
            .kind = PLUMB_DISTANCE, .body_a = a, .body_b = b, .anchor_b = { 3, 0 }, .length = 2 });
    check(w, 1.5, 1);
    assert_near(plumb_world_energy(w).kinetic, 0, 0);
    plumb_joint_set_enabled(w, j, false);
    assert_near(stored(w), 0, 0);
    plumb_joint_set_enabled(w, j, true);
    check(w, 1.5, 1);
    plumb_body_set_enabled(w, b, false);
    assert_near(stored(w), 0, 0);
    plumb_body_set_enabled(w, b, true);
    plumb_joint_set_spring(w, j, 0, 0, 0); // a rod, far from its length
    assert_near(stored(w), 0, 0);
    plumb_world_destroy(w);
}

// A spring beside the centre turns the body too: 1/m = 1/M + r^2 / I.
static void springs_beside_the_centre_meet_less(void **state)
{
    (void)state;
    plumb_world *w = sim_space();
    plumb_body b = sim_mass(w, 0, 0, 4, 0.5);
    tie(w, (plumb_joint_desc){ .kind = PLUMB_DISTANCE,
                               .body_b = b,
                               .anchor = { 1, 2 },
                               .anchor_b = { 1, 0 },
                               .length = 1.5 });
    check(w, 1 / (1 / 4.0 + 1 / 0.5), 0.5);
    plumb_world_destroy(w);
}

static void rotary_and_sliding_springs(void **state)
{
    (void)state;
    plumb_world *w = sim_space();
    plumb_body b = sim_mass(w, 0, 0, 4, 0.5);
    plumb_joint j =
        tie(w, (plumb_joint_desc){ .kind = PLUMB_REVOLUTE, .body_b = b, .rest = (plumb_real)0.3 });
    check(w, 0.5, 0.3);
    plumb_joint_destroy(w, j);
    j = tie(w, (plumb_joint_desc){ .kind = PLUMB_WELD, .body_b = b, .rest = (plumb_real)-0.2 });
    check(w, 0.5, 0.2);
    plumb_joint_destroy(w, j);
    j = tie(w, (plumb_joint_desc){ .kind = PLUMB_WHEEL, .body_b = b, .rest = 2 });
    check(w, 4, 2);
    plumb_joint_destroy(w, j);
    j = tie(w, (plumb_joint_desc){ .kind = PLUMB_PRISMATIC, .body_b = b, .rest = -1 });
    check(w, 4, 1);
    plumb_world_destroy(w);
}

// A mouse joint is a spring in the plane; beyond its bound it stores force times way.
static void mouse_joints_are_springs(void **state)
{
    (void)state;
    plumb_world *w = sim_space();
    plumb_body b = sim_mass(w, 0, 0, 4, 0);
    plumb_joint j = tie(w, (plumb_joint_desc){ .kind = PLUMB_MOUSE, .body_b = b });
    plumb_joint_set_target(w, j, sim_vec(3, 4));
    check(w, 4, 5);
    plumb_joint_destroy(w, j);
    const double most = 100, k = OMEGA * OMEGA * 4, x = most / k;
    j = tie(w, (plumb_joint_desc){ .kind = PLUMB_MOUSE, .body_b = b, .max_force = 100 });
    plumb_joint_set_target(w, j, sim_vec(0, 5));
    assert_near(stored(w) / (k * x * x / 2 + most * (5 - x)), 1, ROUNDED(1e-4));
    plumb_world_destroy(w);
}

// A motor joint is one in the plane and one of the angle.
static void motor_joints_are_two(void **state)
{
    (void)state;
    plumb_world *w = sim_space();
    plumb_body b = sim_mass(w, 0, 0, 4, 0.5);
    plumb_joint j =
        tie(w, (plumb_joint_desc){ .kind = PLUMB_MOTOR, .body_b = b, .rest = (plumb_real)0.5 });
    plumb_joint_set_target(w, j, sim_vec(0, 2));
    const double k = OMEGA * OMEGA;
    assert_near(stored(w) / (k * 4 * 4 / 2 + k * 0.5 * 0.25 / 2), 1, ROUNDED(1e-4));
    plumb_world_destroy(w);
}

// Of springs in newtons it is k x^2 / 2, whatever the masses.
static void springs_in_newtons_store_what_they_say(void **state)
{
    (void)state;
    const double k = 70, most = 100, x = most / k;
    for (int heavy = 1; heavy <= 10; heavy += 9) {
        plumb_world *w = sim_space();
        plumb_body b = sim_mass(w, 3, 0, heavy, 0.5 * heavy);
        const plumb_joint_desc rod = { .kind = PLUMB_DISTANCE,
                                       .body_b = b,
                                       .anchor_b = { 3, 4 }, // far from its centre
                                       .length = 2,
                                       .stiffness = (plumb_real)k };
        plumb_joint j = plumb_joint_create(w, &rod);
        assert_near(stored(w) / (k * 9 / 2), 1, ROUNDED(1e-5));
        plumb_joint_destroy(w, j);
        const plumb_joint_desc pulled = { .kind = PLUMB_MOUSE,
                                          .body_b = b,
                                          .anchor = { 3, 4 },
                                          .stiffness = (plumb_real)k,
                                          .max_force = (plumb_real)most };
        j = plumb_joint_create(w, &pulled);
        plumb_joint_set_target(w, j, sim_vec(3 + 0.6, 4 - 0.8));
        assert_near(stored(w) / (k / 2), 1, ROUNDED(1e-5));
        plumb_joint_set_target(w, j, sim_vec(3, 4 + 5));
        assert_near(stored(w) / (k * x * x / 2 + most * (5 - x)), 1, ROUNDED(1e-5));
        plumb_joint_destroy(w, j);
        const plumb_joint_desc turned = { .kind = PLUMB_REVOLUTE,
                                          .body_b = b,
                                          .rest = (plumb_real)-0.5,
                                          .stiffness = (plumb_real)k };
        j = plumb_joint_create(w, &turned);
        assert_near(stored(w) / (k * 0.25 / 2), 1, ROUNDED(1e-5));
        plumb_world_destroy(w);
    }
}

// A mass on a spring: what the spring gives, the mass has. Off by what the substep makes of it, at 3840 Hz little.
static void a_swinging_mass_keeps_the_sum(void **state)
{
    (void)state;
    plumb_world *w = sim_world(&(plumb_world_desc){ .substeps = 64 });
    plumb_body b = sim_mass(w, 0, -2, 3, 0);
    tie(w, (plumb_joint_desc){ .kind = PLUMB_DISTANCE, .body_b = b, .anchor_b = { 0, -2 } });
    const plumb_energy start = plumb_world_energy(w);
    double most = 0, off = 0;
    for (int i = 0; i < 60; ++i) {
        sim_step(w, 1 / 60.0);
        const plumb_energy e = plumb_world_energy(w);
        most = fmax(most, e.stored);
        off = fmax(off, fabs(e.kinetic + e.potential + e.stored - start.potential));
    }
    print_message("spring under a weight: %.4f J stored at most, sum off by %.2g J\n", most, off);
    const double give = 2 * SIM_G / (OMEGA * OMEGA);
    assert_near(most / (OMEGA * OMEGA * 3 * give * give / 2), 1, 0.01);
    assert_true(off < 0.01 * most);
    plumb_world_destroy(w);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(distance_springs_meet_the_reduced_mass),
        cmocka_unit_test(springs_beside_the_centre_meet_less),
        cmocka_unit_test(rotary_and_sliding_springs),
        cmocka_unit_test(springs_in_newtons_store_what_they_say),
        cmocka_unit_test(mouse_joints_are_springs),
        cmocka_unit_test(motor_joints_are_two),
        cmocka_unit_test(a_swinging_mass_keeps_the_sum),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
