// test_wind.c - what blows: terminal speeds, drag that carries, profiles, what holds against it, against closed forms.
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "harness/near.h"
#include "harness/sim.h"

#define RHO 1.2 // [kg/m^2] of air
#define C   1.8 // its drag

static plumb_body air(plumb_world *w, plumb_material_desc desc)
{
    desc.density = (plumb_real)RHO;
    desc.fluid = desc.weightless = desc.no_skin_drag = true;
    plumb_material m = plumb_material_create(w, &desc);
    plumb_body sky = sim_body(w, PLUMB_STATIC, 0, 0, 0);
    const plumb_shape_desc shape = { .kind = PLUMB_BOX,
                                     .center = sim_vec(0, 1000),
                                     .half = sim_vec(1000, 1000),
                                     .sensor = true,
                                     .material = m };
    assert_false(plumb_is_null(plumb_shape_create(w, sky, &shape)));
    return sky;
}

static plumb_world *windy(int substeps, bool gravity)
{
    return sim_world(
        &(plumb_world_desc){ .substeps = substeps, .no_sleep = true, .zero_gravity = !gravity });
}

static plumb_material solid(plumb_world *w, double density)
{
    return plumb_material_create(w, &(plumb_material_desc){ .density = (plumb_real)density });
}

// v = vt tanh(g t / vt), vt^2 = 2 m g / (rho C width); of a disc two thirds of the width.
static double falling_error(bool disc, double dt)
{
    plumb_world *w = windy(1, true);
    air(w, (plumb_material_desc){ .gust = 0 });
    plumb_material m = solid(w, 4);
    plumb_body b = disc ? sim_ball(w, 0, 1500, 0.5, m) : sim_crate(w, 0, 1500, 0.5, 0.5, m);
    const double mass = disc ? SIM_PI : 4, width = disc ? 2.0 / 3 : 1;
    const double g = -(double)plumb_world_gravity(w).y, vt = sqrt(2 * mass * g / (RHO * C * width));
    double worst = 0;
    for (int i = 1; i * dt < 4; ++i) {
        sim_step(w, dt);
        worst = fmax(worst, fabs(-sim_vy(w, b) - vt * tanh(g * i * dt / vt)) / vt);
    }
    sim_run(w, 300, dt);
    assert_true(fabs(-sim_vy(w, b) / vt - 1) < 1e-5);
    plumb_world_destroy(w);
    return worst;
}

static void what_falls_goes_to_its_terminal_speed(void **state)
{
    (void)state;
    for (int disc = 0; disc < 2; ++disc) {
        double error[3];
        for (int i = 0; i < 3; ++i) {
            error[i] = falling_error(disc == 1, (double)(plumb_real)(0.1 / (1 << i)));
        }
        print_message("%s: speed off by %.2g, %.2g, %.2g of the terminal one, order %.2f\n",
                      disc ? "disc" : "box", error[0], error[1], error[2], sim_order(error, 3));
        assert_true(sim_order(error, 3) > 1.9 && error[2] < 1e-3);
    }
}

// The wind gains on it as 1 / (1 + k U t): exact at any step; turned by any angle, by the edges that face it.
static void wind_carries_along(void **state)
{
    (void)state;
    const double turned[] = { 0, SIM_PI / 4 };
    for (int i = 0; i < 2; ++i) {
        plumb_world *w = windy(1, false);
        air(w, (plumb_material_desc){ .flow_x = 10 });
        plumb_body b = sim_body(w, PLUMB_DYNAMIC, 0, 500, turned[i]);
        sim_add_box(w, b, 0.5, 0.5, solid(w, 1));
        // Two edges at 45 degrees: (1/2) each, times cos 45 along the wind
        const double k = RHO * C / 2 * (i == 0 ? 1 : sqrt(0.5));
        double worst = 0;
        for (int n = 1; n <= 50; ++n) {
            sim_step(w, (double)(plumb_real)0.1);
            worst = fmax(worst, fabs((10 - sim_vx(w, b)) * (1 + k * 10 * n * 0.1) / 10 - 1));
        }
        print_message("box turned by %.2f: behind the wind by %.2g too much\n", turned[i], worst);
        assert_true(worst < SIM_TOLERANCE(1e-4, 1e-8));
        plumb_world_destroy(w);
    }
}

// U (1 - exp(-z / d)) above the bottom.
static void wind_is_weaker_near_the_ground(void **state)
{
    (void)state;
    const double heights[] = { 0.7, 2, 8, 40 };
    plumb_world *w = windy(1, false);
    air(w, (plumb_material_desc){ .flow_x = 5, .shear_height = 4 });
    for (int i = 0; i < 4; ++i) {
        plumb_body b = sim_crate(w, 3 * i, heights[i], 0.5, 0.5, solid(w, 1000));
        sim_step(w, (double)(plumb_real)0.01);
        const double u = 5 * (1 - exp(-heights[i] / 4)), a = RHO * C / 2 * u * u / 1000;
        print_message("at %4.1f m the wind is %.4f m/s, of %.4f\n", heights[i],
                      sqrt(sim_vx(w, b) / 0.01 * 1000 / (RHO * C / 2)), u);
        assert_true(fabs(sim_vx(w, b) / (a * 0.01) - 1) < 1e-4);
    }
    plumb_world_destroy(w);
}

// Friction holds a crate until the wind on its side is more than mu m g.
static void friction_holds_against_the_wind(void **state)
{
    (void)state;
    const double shares[] = { 0.97, 1.03 };
    for (int i = 0; i < 2; ++i) {
        plumb_world *w = windy(4, true);
        const double g = -(double)plumb_world_gravity(w).y,
                     u = sqrt(2 * 0.5 * 2 * 2 * g / (RHO * C * 1));
        air(w, (plumb_material_desc){ .flow_x = (plumb_real)(u * sqrt(shares[i])) });
        plumb_material m = plumb_material_create(
            w, &(plumb_material_desc){ .density = 2, .friction = (plumb_real)0.5 });
        plumb_body crate = sim_crate(w, 0, 0.5, 1, 0.5, m);
        sim_floor(w, m);
        sim_run(w, 180, 1 / 60.0);
        print_message("%.2f of what friction bears: slid %.4f m\n", shares[i], sim_x(w, crate));
        assert_true(i == 0 ? sim_x(w, crate) < 1e-3 : sim_x(w, crate) > 0.1);
        plumb_world_destroy(w);
    }
}

// What spins and is not slowed goes in circles of m v / (2 rho area w), and keeps its speed.
static void spin_lifts(void **state)
{
    (void)state;
    plumb_world *w = windy(4, false);
    air(w, (plumb_material_desc){ .no_drag = true, .magnus = (plumb_real)0.5 });
    plumb_body ball = sim_ball(w, 0, 500, 0.5, solid(w, 4));
    sim_launch(w, ball, 10, 0, 20);
    const double turn = 0.5 * 2 * RHO / 4 * 20, radius = 10 / turn; // [rad/s]
    double worst = 0;
    for (int i = 1; i <= 600; ++i) {
        sim_step(w, 1 / 60.0);
        worst =
            fmax(worst, fabs(hypot(sim_x(w, ball), sim_y(w, ball) - 500 - radius) / radius - 1));
    }
    const double speed = hypot(sim_vx(w, ball), sim_vy(w, ball));
    print_message("a circle of %.3f m: off by %.2g of it, speed by %.2g\n", radius, worst,
                  speed / 10 - 1);
    assert_true(worst < 1e-3 && fabs(speed / 10 - 1) < SIM_TOLERANCE(1e-4, 1e-10));
    plumb_world_destroy(w);
}

// Nothing blows outside of the zone; one that spins is a whirl.
static void zones_end_and_turn(void **state)
{
    (void)state;
    plumb_world *w = windy(1, false);
    plumb_material m = plumb_material_create(
        w, &(plumb_material_desc){ .density = 1.2f, .fluid = true, .weightless = true });
    plumb_body whirl = sim_body(w, PLUMB_KINEMATIC, 0, 0, 0);
    plumb_shape_create(
        w, whirl,
        &(plumb_shape_desc){ .kind = PLUMB_CIRCLE, .radius = 10, .sensor = true, .material = m });
    plumb_body_set_angular_velocity(w, whirl, 2);
    plumb_body in = sim_ball(w, 5, 0, 0.5, solid(w, 1)), out = sim_ball(w, 12, 0, 0.5, solid(w, 1));
    sim_run(w, 6, 1 / 60.0);
    // Slower than the air, 10 m/s there, and along it.
    assert_true(sim_vy(w, in) > 1 && sim_vy(w, in) < 10);
    assert_true(fabs(sim_vx(w, in)) < 0.2 * sim_vy(w, in));
    assert_true(sim_vx(w, out) == 0 && sim_vy(w, out) == 0);
    plumb_world_destroy(w);
}

// Gusts go by the world's time alone: the same whenever it is asked, and about the wind's own speed in the mean.
static void gusts_are_of_their_size(void **state)
{
    (void)state;
    plumb_world *w = windy(1, false);
    air(w, (plumb_material_desc){ .flow_x = 10, .gust = (plumb_real)0.2, .gust_length = 20 });
    // What is too heavy to move tells the wind by its acceleration.
    plumb_body rock = sim_body(w, PLUMB_DYNAMIC, 0, 500, 0);
    sim_add_box(w, rock, 0.5, 0.5, solid(w, 1e6));
    double sum = 0, squares = 0;
    const int count = 20000;
    for (int i = 0; i < count; ++i) {
        sim_step(w, 0.25);
        const double u = sqrt(sim_vx(w, rock) / 0.25 * 1e6 / (RHO * C / 2));
        sim_launch(w, rock, 0, 0, 0);
        sum += u;
        squares += u * u;
    }
    const double mean = sum / count, rms = sqrt(squares / count - mean * mean);
    print_message("gusts: mean %.3f of 10 m/s, rms %.3f of 2\n", mean, rms);
    assert_true(fabs(mean - 10) < 0.1 && fabs(rms - 2) < 0.1);
    plumb_world_destroy(w);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(what_falls_goes_to_its_terminal_speed),
        cmocka_unit_test(wind_carries_along),
        cmocka_unit_test(wind_is_weaker_near_the_ground),
        cmocka_unit_test(friction_holds_against_the_wind),
        cmocka_unit_test(spin_lifts),
        cmocka_unit_test(zones_end_and_turn),
        cmocka_unit_test(gusts_are_of_their_size),
    };
    return cmocka_run_group_tests_name("wind", tests, NULL, NULL);
}
