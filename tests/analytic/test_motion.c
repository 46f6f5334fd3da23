// test_motion.c - bodies in time of their own, and kinematic bodies that are sent to targets.
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "harness/near.h"
#include "harness/sim.h"

#define HZ60 (1 / 60.0)

static double step_of(double rate)
{
    return (double)(plumb_real)(1 / rate);
}

//---- own time ------------------------------------------------------------------------------------

static void slow_motion_follows_the_same_parabola(void **state)
{
    (void)state;
    const double scales[] = { 0.25, 0.1, 1e-3, 3, 0 };
    for (int k = 0; k < 5; ++k) {
        plumb_world *w = sim_world(&(plumb_world_desc){ 0 });
        plumb_material m = sim_material(w, 0, 0);
        plumb_body b = sim_ball(w, 0, 10, 0.5, m);
        sim_launch(w, b, 3, 4, 2);
        double s = (double)(plumb_real)scales[k], dt = step_of(60), worst = 0;
        double g = (double)plumb_world_gravity(w).y;
        plumb_body_set_time_scale(w, b, (plumb_real)s);
        for (int i = 1; i <= 120; ++i) {
            sim_step(w, dt);
            double t = s * i * dt;
            worst =
                fmax(worst, hypot(sim_x(w, b) - 3 * t, sim_y(w, b) - (10 + 4 * t + g * t * t / 2)));
            worst = fmax(worst, fabs(sim_vy(w, b) - (4 + g * t)));
        }
        print_message("projectile at %5.3g of the world's time: off by %.2g\n", scales[k], worst);
        assert_true(worst <= SIM_TOLERANCE(1e-4, 1e-12));
        plumb_world_destroy(w);
    }
}

// Boxes of different times stacked on one another rest, and each carries what lies on it.
static void stack_of_different_times_rests(void **state)
{
    (void)state;
    const plumb_solver solvers[] = { PLUMB_SOLVER_SOFT, PLUMB_SOLVER_PGS, PLUMB_SOLVER_EXACT };
    for (int s = 0; s < 3; ++s) {
        plumb_world *w = sim_world(&(plumb_world_desc){ .solver = solvers[s] });
        plumb_material m = sim_material(w, 0.6, 0);
        plumb_body box[4], ground = sim_floor(w, m);
        const double scales[] = { 0.5, 1, 0.25, 2 };
        for (int i = 0; i < 4; ++i) {
            box[i] = sim_crate(w, 0, 0.5 + i, 0.5, 0.5, m);
            plumb_body_set_time_scale(w, box[i], (plumb_real)scales[i]);
        }
        sim_run(w, 900, HZ60);
        double worst = 0;
        for (int i = 0; i < 4; ++i) {
            double force = sim_normal_force(w, i == 0 ? ground : box[i - 1], box[i], HZ60);
            worst = fmax(worst, fabs(force / ((4 - i) * SIM_G) - 1));
            assert_true(hypot(sim_vx(w, box[i]), sim_vy(w, box[i])) < 0.01);
            assert_near(sim_x(w, box[i]), 0, 0.01);
            assert_near(sim_y(w, box[i]) - (0.5 + i), 0, 0.03);
        }
        print_message("stack of times 0.5, 1, 0.25, 2: forces within %.2g\n", worst);
        assert_true(worst < 0.01);
        plumb_world_destroy(w);
    }
}

// A bob on a rod of 1 m swings at a period of 2 pi sqrt(L / g) / s.
static void slow_pendulum(void **state)
{
    (void)state;
    const double scales[] = { 0.25, 0.5, 1, 2 };
    for (int k = 0; k < 4; ++k) {
        plumb_world *w = sim_world(&(plumb_world_desc){ 0 });
        plumb_body b = sim_ball(w, sin(0.05), -cos(0.05), 0.1, sim_material(w, 0, 0));
        plumb_body_set_locks(w, b, (plumb_axis_locks){ .rotation = true });
        plumb_joint_create(w, &(plumb_joint_desc){ .kind = PLUMB_DISTANCE,
                                                   .body_b = b,
                                                   .anchor = sim_vec(0, 0),
                                                   .anchor_b = sim_vec(sin(0.05), -cos(0.05)) });
        plumb_body_set_time_scale(w, b, (plumb_real)scales[k]);
        int crossings = 0;
        double last = 0, x = sim_x(w, b);
        for (int i = 1; crossings < 5 && i < 4000; ++i) {
            double before = x;
            sim_step(w, HZ60);
            x = sim_x(w, b);
            if ((x < 0) != (before < 0)) {
                last = (i - 1 + before / (before - x)) * HZ60;
                ++crossings;
            }
        }
        // The fifth crossing comes after two periods and a quarter.
        double period = last / 2.25, want = 2 * SIM_PI / sqrt(SIM_G) / scales[k];
        print_message("pendulum at %.2f of the world's time: %.4f s, exactly %.4f s\n", scales[k],
                      period, want);
        assert_near(period / want, 1, 5e-3);
        plumb_world_destroy(w);
    }
}

// A stack in which time stands still for two boxes, then goes on: nothing has moved, nothing jumps.
static void a_frozen_stack_goes_on(void **state)
{
    (void)state;
    const plumb_solver solvers[] = { PLUMB_SOLVER_SOFT, PLUMB_SOLVER_PGS, PLUMB_SOLVER_EXACT };
    for (int s = 0; s < 3; ++s) {
        plumb_world *w = sim_world(&(plumb_world_desc){ .solver = solvers[s] });
        plumb_material m = sim_material(w, 0.6, 0.2);
        plumb_body box[4];
        sim_floor(w, m);
        for (int i = 0; i < 4; ++i) {
            box[i] = sim_crate(w, 0, 0.5 + i, 0.5, 0.5, m);
        }
        sim_run(w, 120, HZ60);
        double top = sim_y(w, box[3]), low = sim_y(w, box[0]);
        plumb_body_set_time_scale(w, box[0], 0);
        plumb_body_set_time_scale(w, box[1], 0);
        sim_run(w, 120, HZ60);
        assert_true(sim_y(w, box[0]) == low);
        assert_near(sim_y(w, box[3]), top, 0.01);
        plumb_body_set_time_scale(w, box[0], 1);
        plumb_body_set_time_scale(w, box[1], 1);
        double fastest = 0;
        for (int i = 0; i < 120; ++i) {
            sim_step(w, HZ60);
            fastest = fmax(fastest, sim_max_speed(w));
        }
        print_message("stack thawed: fastest %.3g m/s, top off by %.2g m\n", fastest,
                      sim_y(w, box[3]) - top);
        assert_true(fastest < 0.1);
        assert_near(sim_y(w, box[3]), top, 0.01);
        plumb_world_destroy(w);
    }
}

// Energy m v^2 / 2 is kept, and sum m v / s, when discs of different time collide.
static void different_times_collide_elastically(void **state)
{
    (void)state;
    plumb_world *w = sim_space();
    plumb_material m = sim_material(w, 0, 1);
    plumb_body a = sim_ball(w, -3, 0, 0.5, m), b = sim_ball(w, 0, 0, 0.5, m);
    plumb_body_set_time_scale(w, b, (plumb_real)0.5);
    sim_launch(w, a, 4, 0, 0);
    sim_run(w, 120, HZ60);
    // b counts four times its mass: V_a' = 4 (1 - 4) / (1 + 4), V_b' = 8 / 5, and v_b = V_b / s.
    assert_near(sim_vx(w, a), -2.4, ROUNDED(1e-5));
    assert_near(sim_vx(w, b), 3.2, ROUNDED(1e-5));
    plumb_world_destroy(w);
}

//---- targets -------------------------------------------------------------------------------------

static void targets_are_met_exactly(void **state)
{
    (void)state;
    unsigned seed = 7;
    plumb_world *w = sim_world(&(plumb_world_desc){ 0 });
    plumb_body b = sim_body(w, PLUMB_KINEMATIC, 0, 0, 0);
    for (int i = 0; i < 200; ++i) {
        double x = sim_uniform(&seed, -50, 50), y = sim_uniform(&seed, -50, 50);
        double angle = sim_uniform(&seed, -20, 20), before = sim_angle(w, b);
        int steps = 1 + i % 3;
        assert_int_equal(plumb_body_set_target(w, b, sim_vec(x, y), (plumb_real)angle,
                                               (plumb_real)(steps * HZ60)),
                         PLUMB_OK);
        // The shorter way round.
        assert_true(fabs(sim_w(w, b)) * steps * HZ60 <= SIM_PI * (1 + 1e-6));
        for (int k = 0; k < steps; ++k) {
            assert_true(plumb_body_has_target(w, b));
            sim_step(w, HZ60);
        }
        plumb_rot want = plumb_rot_make((plumb_real)angle), is = plumb_body_transform(w, b).q;
        assert_true(sim_x(w, b) == (double)(plumb_real)x && sim_y(w, b) == (double)(plumb_real)y);
        assert_true(is.c == want.c && is.s == want.s);
        assert_true(sim_vx(w, b) == 0 && sim_vy(w, b) == 0 && sim_w(w, b) == 0);
        assert_false(plumb_body_has_target(w, b));
        (void)before;
    }
    plumb_world_destroy(w);
}

// A lift carries a box: it rises with the floor and stays on it.
static void lift_by_targets_carries_a_box(void **state)
{
    (void)state;
    plumb_world *w = sim_world(&(plumb_world_desc){ 0 });
    plumb_material m = sim_material(w, 0.6, 0);
    plumb_body lift = sim_body(w, PLUMB_KINEMATIC, 0, -0.5, 0);
    sim_add_box(w, lift, 2, 0.5, m);
    plumb_body box = sim_crate(w, 0, 0.5, 0.5, 0.5, m);
    sim_run(w, 60, HZ60);
    double worst = 0;
    for (int i = 1; i <= 120; ++i) {
        plumb_body_set_target(w, lift, sim_vec(0, -0.5 + 0.02 * i), 0, (plumb_real)HZ60);
        sim_step(w, HZ60);
        worst = fmax(worst, fabs(sim_y(w, box) - sim_y(w, lift) - 1));
    }
    print_message("box on a lift: gap within %.2g m\n", worst);
    assert_true(worst < 2e-3);
    plumb_world_destroy(w);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(slow_motion_follows_the_same_parabola),
        cmocka_unit_test(stack_of_different_times_rests),
        cmocka_unit_test(slow_pendulum),
        cmocka_unit_test(a_frozen_stack_goes_on),
        cmocka_unit_test(different_times_collide_elastically),
        cmocka_unit_test(targets_are_met_exactly),
        cmocka_unit_test(lift_by_targets_carries_a_box),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
