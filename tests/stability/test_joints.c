// test_joints.c - joints under hard loads: a heavy ball on a light chain, long bridges, ragdolls,
// grids. Everything stays finite and joints stay together; how well is printed.
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>

#include <cmocka.h>

#include "harness/sim.h"

#define DT (1 / 60.0)

static plumb_joint hinge(plumb_world *w, plumb_body a, plumb_body b, double x, double y)
{
    plumb_joint j = plumb_joint_create(
        w, &(plumb_joint_desc){
               .kind = PLUMB_REVOLUTE, .body_a = a, .body_b = b, .anchor = sim_vec(x, y) });
    assert_false(plumb_is_null(j));
    return j;
}

// [m] largest error of any joint now; not a number where something is not finite.
static double worst_error(plumb_world *w)
{
    static plumb_joint joints[4096];
    int count = plumb_world_joints(w, joints, 4096);
    double worst = 0;
    for (int i = 0; i < count && i < 4096; ++i) {
        double e = (double)plumb_joint_error(w, joints[i]);
        worst = e <= worst ? worst : e;
    }
    return worst;
}

// Runs; the largest error while it runs, and over the last second.
static double run(plumb_world *w, const char *name, int steps, double *late)
{
    double worst = 0;
    *late = 0;
    for (int i = 0; i < steps; ++i) {
        sim_step(w, DT);
        double e = worst_error(w);
        assert_true(isfinite(e));
        worst = fmax(worst, e);
        *late = i >= steps - 60 ? fmax(*late, e) : *late;
    }
    print_message(
        "%-34s joint error %.3g m at worst, %.3g m in the last second, fastest %.3g m/s\n", name,
        worst, *late, sim_max_speed(w));
    return worst;
}

static const plumb_material none = PLUMB_NULL_INIT;

// A ball of `ratio` times the mass of a link swings from 30 links that begin level.
static void ball_and_chain_holds(void **state)
{
    (void)state;
    const double ratios[] = { 1, 10, 100, 400 };
    // Of 40 balls of about 10 links: 0.07 in the mean, 0.105 at most.
    const double bounds[] = { 0.15, 0.12, 0.1, 0.2 };
    for (size_t k = 0; k < sizeof ratios / sizeof ratios[0]; ++k) {
        plumb_world *w = sim_world(&(plumb_world_desc){ 0 });
        plumb_body last = PLUMB_NULL_INIT;
        for (int i = 0; i < 30; ++i) {
            plumb_body link = sim_crate(w, i + 0.5, 0, 0.5, 0.125, none);
            hinge(w, last, link, i, 0);
            last = link;
        }
        plumb_body ball = sim_ball(w, 32, 0, 2, none);
        plumb_body_set_mass(w, ball, (plumb_real)(0.25 * ratios[k]));
        hinge(w, last, ball, 30, 0);
        char name[64];
        double late;
        snprintf(name, sizeof name, "chain of 30, ball of %g links", ratios[k]);
        double worst = run(w, name, 900, &late);
        assert_true(worst < bounds[k]);
        plumb_world_destroy(w);
    }
}

static void bridge_hangs_still(void **state)
{
    (void)state;
    const int lengths[] = { 20, 160 };
    for (size_t k = 0; k < 2; ++k) {
        plumb_world *w = sim_world(&(plumb_world_desc){ 0 });
        plumb_body last = PLUMB_NULL_INIT;
        int n = lengths[k];
        for (int i = 0; i < n; ++i) {
            plumb_body plank = sim_crate(w, i + 0.5, 0, 0.5, 0.125, none);
            hinge(w, last, plank, i, 0);
            last = plank;
        }
        hinge(w, last, (plumb_body)PLUMB_NULL_INIT, n, 0);
        char name[64];
        double late;
        snprintf(name, sizeof name, "bridge of %d", n);
        double worst = run(w, name, 1200, &late);
        assert_true(worst < (n == 20 ? 0.015 : 0.06));
        assert_true(late < (n == 20 ? 0.007 : 0.06)); // the long one swings for minutes
        plumb_world_destroy(w);
    }
}

// Torso, head, arms and legs with limits, thrown on the floor.
static void ragdolls_come_to_rest(void **state)
{
    (void)state;
    plumb_world *w = sim_world(&(plumb_world_desc){ 0 });
    plumb_material skin = sim_material(w, 0.6, 0);
    sim_floor(w, skin);
    for (int n = 0; n < 5; ++n) {
        double x = n * 0.6, y = 2 + 1.5 * n;
        plumb_body torso = sim_crate(w, x, y, 0.15, 0.35, skin);
        const double parts[][6] = { // centre, half box, joint, all from the torso's centre
                                    { 0, 0.5, 0.12, 0.12, 0, 0.37 },
                                    { 0.4, 0.25, 0.22, 0.06, 0.17, 0.25 },
                                    { -0.4, 0.25, 0.22, 0.06, -0.17, 0.25 },
                                    { 0.1, -0.65, 0.07, 0.28, 0.1, -0.36 },
                                    { -0.1, -0.65, 0.07, 0.28, -0.1, -0.36 }
        };
        for (int p = 0; p < 5; ++p) {
            const double *d = parts[p];
            plumb_body part = sim_crate(w, x + d[0], y + d[1], d[2], d[3], skin);
            plumb_joint j =
                plumb_joint_create(w, &(plumb_joint_desc){ .kind = PLUMB_REVOLUTE,
                                                           .body_a = torso,
                                                           .body_b = part,
                                                           .anchor = sim_vec(x + d[4], y + d[5]),
                                                           .enable_limit = true,
                                                           .lower = -1,
                                                           .upper = 1 });
            assert_false(plumb_is_null(j));
        }
        sim_launch(w, torso, 3, 0, 4);
    }
    double late;
    double worst = run(w, "five ragdolls fall", 900, &late);
    assert_true(worst < 0.3 && late < 0.03);
    assert_true(sim_max_speed(w) < 0.3);
    plumb_world_destroy(w);
}

static void grid_hangs(void **state)
{
    (void)state;
    enum { N = 20 };
    plumb_world *w = sim_world(&(plumb_world_desc){ 0 });
    plumb_body at[N][N];
    for (int i = 0; i < N; ++i) {
        for (int k = 0; k < N; ++k) {
            at[i][k] = sim_body(w, i == 0 && (k == 0 || k == N - 1) ? PLUMB_STATIC : PLUMB_DYNAMIC,
                                k, -i, 0);
            sim_add_circle(w, at[i][k], 0.4, none);
            if (k > 0) {
                hinge(w, at[i][k - 1], at[i][k], k - 0.5, -i);
            }
            if (i > 0) {
                hinge(w, at[i - 1][k], at[i][k], k, -i + 0.5);
            }
        }
    }
    double late;
    double worst = run(w, "grid of 20 x 20 on two nails", 600, &late);
    assert_true(worst < 0.03 && late < 0.02);
    plumb_world_destroy(w);
}

// A wheel on its axle whose spin dies away comes to none: subnormal numbers made a rain of ragdolls
// half as fast.
static void spin_that_dies_away_ends(void **state)
{
    (void)state;
    plumb_world *w = sim_world(&(plumb_world_desc){ .zero_gravity = true, .no_sleep = true });
    plumb_body wheel = sim_ball(w, 0, 0, 0.5, (plumb_material){ 0 });
    plumb_joint_create(w, &(plumb_joint_desc){ .kind = PLUMB_REVOLUTE, .body_b = wheel });
    plumb_body_set_damping(w, wheel, 0, 50);
    sim_launch(w, wheel, 0, 0, 1);
    double least = 1;
    for (int i = 0; i < 2000; ++i) {
        sim_step(w, 1 / 60.0);
        double spin = fabs((double)plumb_body_angular_velocity(w, wheel));
        assert_true(spin == 0 || spin > (sizeof(plumb_real) == 4 ? 1e-30 : 1e-200));
        least = fmin(least, spin);
    }
    assert_true(least == 0);
    plumb_world_destroy(w);
}

// Light links that bear what is up to 10,000 times as heavy as one of them swing without gaining energy: the joints
// give way, but nothing flutters. Before, a ball of 1,000 links' mass had 1e16 times the energy of its fall.
static void heavy_ends_make_no_energy(void **state)
{
    (void)state;
    for (double ratio = 10; ratio <= 10000; ratio *= 10) {
        plumb_world *w = sim_world(&(plumb_world_desc){ .no_sleep = true });
        const plumb_material m = sim_material(w, 0.5, 0);
        const int links = 50;
        plumb_body above = { 0 };
        for (int i = 0; i < links; ++i) {
            const plumb_body link = sim_crate(w, 0.2 * i + 0.1, 0, 0.1, 0.02, m);
            plumb_joint_create(w, &(plumb_joint_desc){ .kind = PLUMB_REVOLUTE,
                                                       .body_a = above,
                                                       .body_b = link,
                                                       .anchor = sim_vec(0.2 * i, 0) });
            above = link;
        }
        const plumb_body ball = sim_ball(w, 0.2 * links + 0.4, 0, 0.4, m);
        const double mass = ratio * (double)plumb_body_mass(w, above);
        plumb_body_set_mass(w, ball, (plumb_real)mass);
        plumb_joint_create(w, &(plumb_joint_desc){ .kind = PLUMB_REVOLUTE,
                                                   .body_a = above,
                                                   .body_b = ball,
                                                   .anchor = sim_vec(0.2 * links, 0) });
        const plumb_energy start = plumb_world_energy(w);
        double gained = 0, lowest = 0;
        for (int i = 0; i < 600; ++i) {
            sim_step(w, 1 / 60.0);
            lowest = fmin(lowest, sim_y(w, ball));
            const plumb_energy e = plumb_world_energy(w);
            gained = fmax(gained, (double)(e.kinetic - start.kinetic) +
                                      (double)(e.potential - start.potential));
        }
        print_message("ball of %5.0f links: lowest %.1f m, gains %.2g of what it fell\n", ratio,
                      -lowest, gained / (mass * SIM_G * -lowest));
        assert_true(gained < 0.01 * mass * SIM_G * -lowest);
        plumb_world_destroy(w);
    }
}

// A motor that is driven into its limit stops there, however strong it is and whichever way. [N m] or [N] of the motor.
static void motors_stop_at_limits(void **state)
{
    (void)state;
    const plumb_joint_kind kinds[] = { PLUMB_REVOLUTE, PLUMB_PRISMATIC };
    const plumb_solver solvers[] = { PLUMB_SOLVER_SOFT, PLUMB_SOLVER_PGS, PLUMB_SOLVER_EXACT };
    for (int i = 0; i < 3 * 2 * 2 * 5; ++i) {
        const double way = i % 2 == 0 ? 1 : -1, most = pow(10, 2 + i / 4 % 5);
        plumb_world_desc desc = { .solver = solvers[i / 20], .zero_gravity = true };
        plumb_world *w = sim_world(&desc);
        plumb_body arm = sim_mass(w, 0.5, 0, 1, 0.1);
        plumb_joint_desc d = { .kind = kinds[i / 2 % 2],
                               .body_b = arm,
                               .enable_limit = true,
                               .lower = (plumb_real)-0.5,
                               .upper = (plumb_real)0.5,
                               .enable_motor = true,
                               .motor_speed = (plumb_real)(10 * way),
                               .max_motor = (plumb_real)most };
        plumb_joint j = sim_joint(w, d);
        double farthest = 0;
        for (int k = 0; k < 60; ++k) {
            sim_step(w, DT);
            farthest = fmax(farthest, way * (double)plumb_joint_value(w, j));
        }
        if (way > 0) {
            print_message("solver %d, %s, motor of %.0e: %.6f, at the end %.6f\n", (int)desc.solver,
                          plumb_joint_kind_name(d.kind), most, farthest,
                          (double)plumb_joint_value(w, j));
        }
        assert_true(farthest < 0.51);
        assert_true(way * (double)plumb_joint_value(w, j) > 0.499);
        plumb_world_destroy(w);
    }
}

// A chain that begins at twice its length draws together: what each joint may gain adds up along it.
static void stretched_chains_draw_together(void **state)
{
    (void)state;
    enum { LINKS = 40 };
    plumb_world *w = sim_world(&(plumb_world_desc){ 0 });
    plumb_body link[LINKS];
    for (int i = 0; i < LINKS; ++i) {
        link[i] = sim_body(w, PLUMB_DYNAMIC, 0, -(i + 0.5) * 0.5, SIM_PI / 2);
        sim_add_box(w, link[i], 0.2, 0.1, none);
        (void)hinge(w, i > 0 ? link[i - 1] : (plumb_body)PLUMB_NULL_INIT, link[i], 0, -i * 0.5);
    }
    for (int i = 0; i < LINKS; ++i) {
        plumb_body_teleport(w, link[i], sim_vec(0, -(i + 0.5)), (plumb_real)(SIM_PI / 2));
    }
    double fastest = 0;
    for (int i = 0; i < 360; ++i) {
        const double was = sim_y(w, link[LINKS - 1]);
        sim_step(w, DT);
        fastest = fmax(fastest, fabs(sim_y(w, link[LINKS - 1]) - was) / DT);
    }
    print_message("a chain at twice its length: end as fast as %.1f m/s, gaps at the end %.2g m\n",
                  fastest, worst_error(w));
    assert_true(fastest < 80); // 40 joints of 2 m/s, and the fall; 210 with no bound
    assert_true(worst_error(w) < 0.01);
    plumb_world_destroy(w);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(ball_and_chain_holds),
        cmocka_unit_test(bridge_hangs_still),
        cmocka_unit_test(ragdolls_come_to_rest),
        cmocka_unit_test(grid_hangs),
        cmocka_unit_test(spin_that_dies_away_ends),
        cmocka_unit_test(heavy_ends_make_no_energy),
        cmocka_unit_test(motors_stop_at_limits),
        cmocka_unit_test(stretched_chains_draw_together),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
