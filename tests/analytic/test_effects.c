// test_effects.c - damping, caps, locked axes, blasts and adhesion against closed forms.
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

//---- damping -------------------------------------------------------------------------------------

// v = v0 E + (a / c) (1 - E), x = a t / c + (v0 - a / c) (1 - E) / c, E = exp(-c t).
static void damped_flight_is_exact(void **state)
{
    (void)state;
    const struct {
        double rate, c;
        int substeps;
    } cases[] = { { 60, 0.5, 4 }, { 60, 5, 1 }, { 60, 300, 4 }, { 10, 2, 4 }, { 240, 1e-3, 16 } };
    for (size_t k = 0; k < sizeof cases / sizeof cases[0]; ++k) {
        plumb_world *w =
            sim_world(&(plumb_world_desc){ .substeps = cases[k].substeps, .no_sleep = true });
        plumb_body b = sim_ball(w, 0, 0, 0.5, sim_material(w, 0, 0));
        plumb_real c = (plumb_real)cases[k].c;
        sim_launch(w, b, 30, 10, 20);
        assert_int_equal(plumb_body_set_damping(w, b, c, 2 * c), PLUMB_OK);
        double dt = step_of(cases[k].rate), g = (double)plumb_world_gravity(w).y;
        double rate = (double)c, worst_x = 0, worst_v = 0, worst_w = 0;
        int steps = (int)(2 * cases[k].rate);
        for (int i = 1; i <= steps; ++i) {
            sim_step(w, dt);
            double t = i * dt, e = exp(-rate * t), one = -expm1(-rate * t);
            worst_v = fmax(worst_v,
                           hypot(sim_vx(w, b) - 30 * e, sim_vy(w, b) - (10 * e + g / rate * one)));
            worst_x =
                fmax(worst_x, hypot(sim_x(w, b) - 30 * one / rate,
                                    sim_y(w, b) - (g * t / rate + (10 - g / rate) * one / rate)));
            worst_w = fmax(worst_w, fabs(sim_w(w, b) - 20 * exp(-2 * rate * t)));
        }
        print_message("damping %5.3g /s at %3.0f Hz: place off by %.2g m, velocity %.2g m/s, spin "
                      "%.2g rad/s\n",
                      cases[k].c, cases[k].rate, worst_x, worst_v, worst_w);
        double bound = SIM_TOLERANCE(1e-5, 1e-10);
        assert_true(worst_x <= bound && worst_v <= bound);
        // Half a spacing a step: what rounding takes from a spin is not carried over.
        assert_true(worst_w <= steps * SIM_EPSILON * 32 / 2);
        plumb_world_destroy(w);
    }
}

// A body that has a joint is moved by the solver, in substeps: the velocity stays exact, the place
// is off by the second order. The joint does nothing to it: a friction joint without friction.
static void damped_motion_in_the_solver_is_second_order(void **state)
{
    (void)state;
    const plumb_solver solvers[] = { PLUMB_SOLVER_SOFT, PLUMB_SOLVER_PGS, PLUMB_SOLVER_EXACT };
    for (int s = 0; s < 3; ++s) {
        double error[4];
        for (int k = 0; k < 4; ++k) {
            plumb_world *w = sim_world(&(plumb_world_desc){ .solver = solvers[s], .substeps = 4 });
            plumb_body b = sim_ball(w, 0, 0, 0.5, sim_material(w, 0, 0));
            plumb_joint_create(w, &(plumb_joint_desc){ .kind = PLUMB_FRICTION, .body_a = b });
            sim_launch(w, b, 300, 0, 0);
            plumb_body_set_damping(w, b, 4, 0);
            int steps = 5 << k;
            sim_run(w, steps, step_of(steps));
            double one = -expm1(-4.0), left = exp(-4.0);
            assert_near(sim_vx(w, b), 300 * left, SIM_TOLERANCE(1e-3, 1e-11));
            error[k] = fabs(sim_x(w, b) - 300 * one / 4);
            plumb_world_destroy(w);
        }
        double order = sim_order(error, 4);
        print_message("damped in the solver: off by %.2g .. %.2g m, order %.2f\n", error[0],
                      error[3], order);
        assert_true(order > 1.8 && order < 2.2);
    }
}

static void damped_body_falls_at_its_top_speed(void **state)
{
    (void)state;
    plumb_world *w = sim_world(&(plumb_world_desc){ 0 });
    plumb_body b = sim_ball(w, 0, 0, 0.5, sim_material(w, 0, 0));
    plumb_body_set_damping(w, b, 2, 0);
    sim_run(w, 1200, HZ60);
    assert_near(sim_vy(w, b), -SIM_G / 2, ROUNDED(1e-5));
    plumb_world_destroy(w);
}

//---- caps ----------------------------------------------------------------------------------------

static void caps_hold_in_flight_and_under_blows(void **state)
{
    (void)state;
    plumb_world *w = sim_world(&(plumb_world_desc){ 0 });
    plumb_material m = sim_material(w, 0.5, 0.9);
    sim_floor(w, m);
    plumb_body slow[6], fast[6];
    for (int i = 0; i < 6; ++i) {
        slow[i] = sim_crate(w, 0.1 * i, 3 + 1.2 * i, 0.5, 0.5, m);
        plumb_body_set_speed_cap(w, slow[i], 4, 2);
        fast[i] = sim_ball(w, 0.1 * i - 0.2, 30 + 10 * i, 0.5, m);
        sim_launch(w, fast[i], 0, -40, 30);
    }
    double fastest = 0, spin = 0, worst_way = 0;
    for (int i = 0; i < 300; ++i) {
        double x[6], y[6];
        for (int k = 0; k < 6; ++k) {
            x[k] = sim_x(w, slow[k]), y[k] = sim_y(w, slow[k]);
        }
        sim_step(w, HZ60);
        for (int k = 0; k < 6; ++k) {
            fastest = fmax(fastest, hypot(sim_vx(w, slow[k]), sim_vy(w, slow[k])));
            spin = fmax(spin, fabs(sim_w(w, slow[k])));
            worst_way = fmax(worst_way, hypot(sim_x(w, slow[k]) - x[k], sim_y(w, slow[k]) - y[k]));
        }
    }
    print_message("capped at 4 m/s, 2 rad/s: %.6f m/s, %.6f rad/s, %.4f m a step\n", fastest, spin,
                  worst_way);
    assert_true(fastest <= 4 * (1 + 4 * SIM_EPSILON));
    assert_true(spin <= 2 * (1 + 4 * SIM_EPSILON));
    plumb_world_destroy(w);
}

// v = min(g t, cap), and the way is its integral but for the step in which the cap is reached.
static void capped_fall(void **state)
{
    (void)state;
    plumb_world *w = sim_world(&(plumb_world_desc){ 0 });
    plumb_body b = sim_ball(w, 0, 0, 0.5, sim_material(w, 0, 0));
    plumb_body_set_speed_cap(w, b, 5, 0);
    sim_run(w, 120, HZ60);
    double reached = 5 / SIM_G, way = 5 * reached / 2 + 5 * (2 - reached);
    assert_near(sim_vy(w, b), -5, ROUNDED(1e-6));
    assert_near(sim_y(w, b) + way, 0, 5 * HZ60 / 8);
    plumb_world_destroy(w);
}

//---- locked axes ---------------------------------------------------------------------------------

// A table locked in y carries a stack as the ground does; free along x, it takes a shove as its
// mass says.
static void locked_table_carries_a_stack(void **state)
{
    (void)state;
    const plumb_solver solvers[] = { PLUMB_SOLVER_SOFT, PLUMB_SOLVER_PGS, PLUMB_SOLVER_EXACT };
    for (int s = 0; s < 3; ++s) {
        double top[2];
        for (int locked = 0; locked < 2; ++locked) {
            plumb_world *w = sim_world(&(plumb_world_desc){ .solver = solvers[s] });
            plumb_material m = sim_material(w, 0.6, 0);
            plumb_body table = sim_body(w, locked ? PLUMB_DYNAMIC : PLUMB_STATIC, 0, -0.5, 0);
            sim_add_box(w, table, 3, 0.5, m);
            if (locked) {
                plumb_axis_locks locks = { .y = true, .rotation = true };
                assert_int_equal(plumb_body_set_locks(w, table, locks), PLUMB_OK);
            }
            plumb_body box[5];
            for (int i = 0; i < 5; ++i) {
                box[i] = sim_crate(w, 0, 0.5 + i, 0.5, 0.5, m);
            }
            sim_run(w, 600, HZ60);
            top[locked] = sim_y(w, box[4]);
            assert_true(sim_y(w, table) == (double)(plumb_real)-0.5);
            assert_near(sim_x(w, table), 0, s == 0 ? 1e-6 : 5e-3);
            double carried = sim_normal_force(w, table, box[0], HZ60);
            assert_near(carried / (5 * SIM_G), 1, 5e-3);
            if (locked) {
                plumb_body_apply_impulse_center(w, table, sim_vec(1, 7));
                double mass = (double)plumb_body_mass(w, table);
                assert_near(sim_vx(w, table), 1 / mass, ROUNDED(1e-3));
                assert_true(sim_vy(w, table) == 0);
            }
            plumb_world_destroy(w);
        }
        print_message("stack of 5 on a table locked in y: top at %.5f m, on the ground %.5f m\n",
                      top[1], top[0]);
        assert_near(top[1], top[0], 2e-3);
    }
}

// Momentum along the free axis is conserved when bodies of locked y collide; energy too, at e = 1.
static void bodies_on_a_rail_collide_as_in_one_dimension(void **state)
{
    (void)state;
    plumb_world *w = sim_space();
    plumb_material m = sim_material(w, 0, 1);
    plumb_body a = sim_ball(w, -2, 0.3, 0.5, m), b = sim_ball(w, 0, 0, 0.5, m);
    plumb_body_set_locks(w, a, (plumb_axis_locks){ .y = true });
    plumb_body_set_locks(w, b, (plumb_axis_locks){ .y = true });
    sim_launch(w, a, 3, 0, 0);
    sim_run(w, 120, HZ60);
    // Equal masses along the rail exchange their velocities, however oblique the normal.
    assert_near(sim_vx(w, a), 0, ROUNDED(1e-5));
    assert_near(sim_vx(w, b), 3, ROUNDED(1e-5));
    assert_true(sim_vy(w, a) == 0 && sim_vy(w, b) == 0);
    assert_true(sim_y(w, b) == 0);
    plumb_world_destroy(w);
}

// A pendulum whose bob may move vertically only, on a hinged rod: hangs, and the joint tells its weight.
static void joint_of_a_locked_body_carries(void **state)
{
    (void)state;
    plumb_world *w = sim_world(&(plumb_world_desc){ 0 });
    plumb_material m = sim_material(w, 0, 0);
    plumb_body slide = sim_ball(w, 0, 0, 0.5, m), load = sim_ball(w, 0, -2, 0.5, m);
    plumb_body_set_locks(w, slide, (plumb_axis_locks){ .y = true, .rotation = true });
    plumb_joint rod = plumb_joint_create(w, &(plumb_joint_desc){ .kind = PLUMB_DISTANCE,
                                                                 .body_a = load,
                                                                 .body_b = slide,
                                                                 .anchor = sim_vec(0, -2),
                                                                 .anchor_b = sim_vec(0, 0) });
    sim_run(w, 120, HZ60);
    double weight = (double)plumb_body_mass(w, load) * SIM_G;
    assert_true(sim_y(w, slide) == 0);
    assert_near(sim_y(w, load), -2, 1e-3);
    assert_near((double)plumb_joint_force(w, rod).y / -weight, 1, ROUNDED(1e-3));
    plumb_world_destroy(w);
}

//---- blasts --------------------------------------------------------------------------------------

// J = p (D (t + sin t cos t) - pi R^2 / (2 D)), sin t = R / D: see plumb_world_explode.
static double disc_impulse(double p, double r, double d)
{
    double t = asin(r / d);
    return p * (d * (t + sin(t) * cos(t)) - SIM_PI * r * r / (2 * d));
}

static void blast_on_a_disc(void **state)
{
    (void)state;
    const double distances[] = { 1.05, 1.5, 3, 20, 500 };
    double worst = 0;
    for (int k = 0; k < 5; ++k) {
        plumb_world *w = sim_space();
        plumb_body b =
            sim_ball(w, 1 + distances[k] * 0.6, 2 + distances[k] * 0.8, 1, sim_material(w, 0, 0));
        plumb_explosion_desc blast = { .position = sim_vec(1, 2), .radius = 1000, .impulse = 7 };
        assert_int_equal(plumb_world_explode(w, &blast), PLUMB_OK);
        double mass = (double)plumb_body_mass(w, b);
        double got = mass * hypot(sim_vx(w, b), sim_vy(w, b));
        double want = disc_impulse(7, 1, distances[k]);
        worst = fmax(worst, fabs(got / want - 1));
        assert_near(sim_vx(w, b) * 0.8, sim_vy(w, b) * 0.6, 1e-3 * got / mass);
        assert_near(sim_w(w, b), 0, ROUNDED(1e-3));
        plumb_world_destroy(w);
    }
    print_message("blast on a disc: impulse within %.2g\n", worst);
    assert_true(worst < 1e-3);
}

// Symmetric surroundings: what the blast gives away sums up to nothing.
static void ring_around_a_blast_keeps_momentum(void **state)
{
    (void)state;
    plumb_world *w = sim_space();
    plumb_material m = sim_material(w, 0, 0);
    for (int i = 0; i < 12; ++i) {
        double a = i * SIM_PI / 6;
        plumb_body b = sim_body(w, PLUMB_DYNAMIC, 3 * cos(a), 3 * sin(a), a);
        sim_add_box(w, b, 0.3, 0.6, m);
    }
    plumb_world_explode(w, &(plumb_explosion_desc){ .radius = 5, .impulse = 10 });
    plumb_energy e = plumb_world_energy(w);
    print_message("ring of 12: momentum %.2g, %.2g, angular %.2g, energy %.3g J\n", e.momentum_x,
                  e.momentum_y, e.angular_momentum, e.kinetic);
    assert_true(hypot(e.momentum_x, e.momentum_y) < SIM_TOLERANCE(1e-4, 1e-11));
    assert_near(e.angular_momentum, 0, SIM_TOLERANCE(1e-4, 1e-11));
    assert_true(e.kinetic > 10);
    plumb_world_destroy(w);
}

// A wall before the lower half of what a target shows of itself.
static void walls_shield(void **state)
{
    (void)state;
    double pushed[3]; // open, half covered, all covered
    for (int k = 0; k < 3; ++k) {
        plumb_world *w = sim_space();
        plumb_material m = sim_material(w, 0, 0);
        plumb_body target = sim_crate(w, 10, 0, 0.5, 1, m);
        if (k > 0) {
            plumb_body wall = sim_body(w, PLUMB_STATIC, 5, k == 1 ? -2 : 0, 0);
            sim_add_box(w, wall, 0.1, 2, m);
        }
        plumb_explosion_desc blast = { .radius = 50,
                                       .impulse = 10,
                                       .occlusion = PLUMB_OCCLUDE_WALLS };
        plumb_world_explode(w, &blast);
        pushed[k] = sim_vx(w, target) * (double)plumb_body_mass(w, target);
        plumb_world_destroy(w);
    }
    print_message("impulse in the open %.3f N s, behind half a wall %.3f, behind a wall %.3f\n",
                  pushed[0], pushed[1], pushed[2]);
    assert_true(pushed[2] == 0);
    assert_near(pushed[1] / pushed[0], 0.5, ROUNDED(0.05));
    // A flat front of 2 m at 9.5 m: p * 2 * 9.5 * atan(1 / 9.5) along x, to the second order.
    assert_near(pushed[0] / 20, 1, 0.01);
}

//---- adhesion ------------------------------------------------------------------------------------

// A disc hung under a ceiling holds if and only if its weight is at most the pull-off force.
static void adhesion_holds_what_it_can(void **state)
{
    (void)state;
    const plumb_solver solvers[] = { PLUMB_SOLVER_SOFT, PLUMB_SOLVER_PGS, PLUMB_SOLVER_EXACT };
    const double loads[] = { 0.2, 0.9, 0.99, 1.01, 1.5 };
    for (int s = 0; s < 3; ++s) {
        for (int shape = 0; shape < 2; ++shape) {
            for (int k = 0; k < 5; ++k) {
                plumb_world *w = sim_world(&(plumb_world_desc){ .solver = solvers[s] });
                plumb_material sticky = plumb_material_create(
                    w, &(plumb_material_desc){ .friction = (plumb_real)0.5, .adhesion = 100 });
                plumb_body ceiling = sim_body(w, PLUMB_STATIC, 0, 1, 0);
                sim_add_box(w, ceiling, 5, 1, sim_material(w, 0, 0));
                plumb_body b = sim_body(w, PLUMB_DYNAMIC, 0, -0.5 - 1e-4, 0);
                if (shape == 0) {
                    sim_add_circle(w, b, 0.5, sticky);
                } else {
                    sim_add_box(w, b, 0.5, 0.5, sticky);
                }
                plumb_body_set_mass(w, b, (plumb_real)(loads[k] * 100 / SIM_G));
                plumb_body_set_gravity_scale(w, b, 0);
                sim_launch(w, b, 0, 0.1, 0); // to touch
                sim_run(w, 10, HZ60);
                plumb_body_set_gravity_scale(w, b, 1);
                sim_run(w, 300, HZ60);
                bool holds = sim_y(w, b) > -0.51;
                assert_int_equal(holds, loads[k] < 1);
                if (holds) {
                    plumb_contact contact;
                    assert_int_equal(plumb_world_contacts(w, &contact, 1), 1);
                    double force = 0;
                    for (int i = 0; i < contact.point_count; ++i) {
                        force += (double)contact.points[i].normal_impulse;
                    }
                    force /= HZ60 / plumb_world_settings(w).substeps;
                    assert_near(force / (loads[k] * 100) + 1, 0, ROUNDED(0.01));
                }
                plumb_world_destroy(w);
            }
        }
    }
}

// On a wall the contact carries nothing along its normal; friction goes by the adhesion:
// it holds while m g <= mu A.
static void sticky_box_stays_on_a_wall(void **state)
{
    (void)state;
    const double loads[] = { 0.5, 0.95, 1.05 };
    for (int k = 0; k < 3; ++k) {
        plumb_world *w = sim_world(&(plumb_world_desc){ 0 });
        plumb_material sticky = plumb_material_create(
            w, &(plumb_material_desc){ .friction = (plumb_real)0.8, .adhesion = 50 });
        plumb_body wall = sim_body(w, PLUMB_STATIC, -1, 0, 0);
        sim_add_box(w, wall, 1, 50, sticky);
        plumb_body b = sim_crate(w, 0.5, 0, 0.5, 0.5, sticky);
        plumb_body_set_mass(w, b, (plumb_real)(loads[k] * 0.8 * 50 / SIM_G));
        plumb_body_set_gravity_scale(w, b, 0);
        sim_launch(w, b, -0.1, 0, 0);
        sim_run(w, 10, HZ60);
        plumb_body_set_gravity_scale(w, b, (plumb_real)1);
        sim_run(w, 240, HZ60);
        print_message("box on a wall at %.2f of mu A: fell %.4f m, %.4f m off\n", loads[k],
                      -sim_y(w, b), sim_x(w, b) - 0.5);
        if (loads[k] < 1) {
            assert_true(fabs(sim_y(w, b)) < 0.01 && fabs(sim_x(w, b) - 0.5) < 0.01);
        } else {
            // What is left of gravity: g (1 - mu A / m g).
            double a = SIM_G * (1 - 1 / loads[k]);
            assert_near(-sim_y(w, b) / (a * 16 / 2), 1, 0.1);
        }
        plumb_world_destroy(w);
    }
}

// Thrown flat against a wall, a box stays where it hit, at any speed, with restitution too.
static void what_is_thrown_sticks(void **state)
{
    (void)state;
    const plumb_solver solvers[] = { PLUMB_SOLVER_SOFT, PLUMB_SOLVER_PGS, PLUMB_SOLVER_EXACT };
    const double speeds[] = { 0.3, 1.7, 6, 13.1 };
    for (int s = 0; s < 3; ++s) {
        for (int k = 0; k < 4; ++k) {
            plumb_world *w = sim_world(&(plumb_world_desc){ .solver = solvers[s] });
            plumb_material tar = plumb_material_create(
                w, &(plumb_material_desc){
                       .friction = 1, .restitution = (plumb_real)0.5, .adhesion = 500 });
            plumb_body wall = sim_body(w, PLUMB_STATIC, -1, 0, 0);
            sim_add_box(w, wall, 1, 50, tar);
            plumb_body b = sim_crate(w, 0.25 + speeds[k] * 0.2, 0, 0.25, 0.25, tar);
            sim_launch(w, b, -speeds[k], 0, 0);
            sim_run(w, 30, HZ60);
            double y = sim_y(w, b);
            sim_run(w, 60, HZ60);
            assert_near(sim_x(w, b), 0.25, 0.01);
            assert_near(sim_y(w, b), y, 1e-3);
            plumb_world_destroy(w);
        }
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(damped_flight_is_exact),
        cmocka_unit_test(damped_motion_in_the_solver_is_second_order),
        cmocka_unit_test(damped_body_falls_at_its_top_speed),
        cmocka_unit_test(caps_hold_in_flight_and_under_blows),
        cmocka_unit_test(capped_fall),
        cmocka_unit_test(locked_table_carries_a_stack),
        cmocka_unit_test(bodies_on_a_rail_collide_as_in_one_dimension),
        cmocka_unit_test(joint_of_a_locked_body_carries),
        cmocka_unit_test(blast_on_a_disc),
        cmocka_unit_test(ring_around_a_blast_keeps_momentum),
        cmocka_unit_test(walls_shield),
        cmocka_unit_test(adhesion_holds_what_it_can),
        cmocka_unit_test(sticky_box_stays_on_a_wall),
        cmocka_unit_test(what_is_thrown_sticks),
    };
    return cmocka_run_group_tests_name("effects", tests, NULL, NULL);
}
