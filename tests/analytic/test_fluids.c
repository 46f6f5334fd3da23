// test_fluids.c - what floats, sinks and is dragged, against closed forms.
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "harness/near.h"
#include "harness/sim.h"

#define RHO 1000.0 // [kg/m^2] of water

// A pool 400 m wide and deep whose surface is the line y = 0.
static plumb_body pool(plumb_world *w, const plumb_material_desc *desc)
{
    plumb_material water = plumb_material_create(w, desc);
    plumb_body ground = sim_body(w, PLUMB_STATIC, 0, 0, 0);
    const plumb_shape_desc shape = { .kind = PLUMB_BOX,
                                     .center = sim_vec(0, -200),
                                     .half = sim_vec(200, 200),
                                     .sensor = true,
                                     .material = water };
    assert_false(plumb_is_null(plumb_shape_create(w, ground, &shape)));
    return ground;
}

static plumb_material solid(plumb_world *w, double density)
{
    return plumb_material_create(w, &(plumb_material_desc){ .density = (plumb_real)density });
}

static plumb_world *world_of(int substeps)
{
    return sim_world(&(plumb_world_desc){ .substeps = substeps, .no_sleep = true });
}

//---- at rest -------------------------------------------------------------------------------------

// [m] by which the centre of a disc of radius 1 is above the surface that floats at a ratio of densities.
static double disc_height(double ratio)
{
    double low = -1, high = 1;
    for (int i = 0; i < 60; ++i) {
        const double c = (low + high) / 2, up = acos(c) - c * sqrt(1 - c * c);
        if (up / SIM_PI > ratio) {
            low = c;
        } else {
            high = c;
        }
    }
    return (low + high) / 2;
}

// A box sinks as deep as its ratio of densities, a disc until the area fits; from 0.3 above and turned.
static void drafts_are_exact(void **state)
{
    (void)state;
    const double ratios[] = { 0.9, 0.5, 0.1, 0.01, 0.001 };
    for (size_t i = 0; i < sizeof ratios / sizeof *ratios; ++i) {
        plumb_world *w = world_of(4);
        pool(w, &(plumb_material_desc){ .density = (plumb_real)RHO, .fluid = true });
        plumb_material m = solid(w, RHO * ratios[i]);
        plumb_body box = sim_crate(w, -9, 0.8, 0.5, 0.5, m);
        plumb_body_set_fixed_rotation(w, box, true);
        plumb_body disc = sim_ball(w, 9, 1.3, 1, m);
        sim_run(w, 60 * 60, 1 / 60.0);
        const double of_box = fabs(sim_y(w, box) - (0.5 - ratios[i]));
        const double of_disc = fabs(sim_y(w, disc) - disc_height(ratios[i]));
        print_message("ratio %5.3f: draft of a box off by %.2g m, of a disc by %.2g m\n", ratios[i],
                      of_box, of_disc);
        assert_true(of_box < 1e-4 &&
                    of_disc < 1e-4); // quadratic drag takes long over the last millimetre
        plumb_world_destroy(w);
    }
}

// A square log floats flat only for ratios below 0.2113 or above 0.7887: GM = 1 / (12 s) - (1 - s) / 2.
static void logs_float_flat_or_do_not(void **state)
{
    (void)state;
    const struct {
        double ratio;
        bool flat;
    } cases[] = { { 0.1, true },   { 0.2, true }, { 0.222, false }, { 0.5, false },
                  { 0.77, false }, { 0.8, true }, { 0.9, true } };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; ++i) {
        plumb_world *w = world_of(4);
        pool(w, &(plumb_material_desc){ .density = (plumb_real)RHO, .fluid = true });
        plumb_body box = sim_body(w, PLUMB_DYNAMIC, 0, 0.5 - cases[i].ratio, 0.02);
        sim_add_box(w, box, 0.5, 0.5, solid(w, RHO * cases[i].ratio));
        sim_run(w, 60 * 60, 1 / 60.0);
        print_message("log of %.3f rests at %.3f rad\n", cases[i].ratio, sim_angle(w, box));
        assert_true((fabs(sim_angle(w, box)) < 0.01) == cases[i].flat);
        plumb_world_destroy(w);
    }
}

// What floats bears what lies on it: contacts know the mass that the water lends.
static void rafts_bear_their_load(void **state)
{
    (void)state;
    const double ratios[] = { 0.3, 0.01, 0.001 };
    for (size_t i = 0; i < sizeof ratios / sizeof *ratios; ++i) {
        plumb_world *w = world_of(4);
        pool(w, &(plumb_material_desc){ .density = (plumb_real)RHO, .fluid = true });
        // 4 m x 1 m with 1 m x 1 m of 0.4 of the water's density on top
        plumb_body raft = sim_crate(w, 0, 0, 2, 0.5, solid(w, RHO * ratios[i]));
        plumb_body load = sim_crate(w, 0, 1, 0.5, 0.5, solid(w, 400));
        sim_run(w, 60 * 60, 1 / 60.0);
        const double draft = ratios[i] + 0.4 / 4, off = fabs(sim_y(w, raft) - (0.5 - draft));
        print_message("raft of %.3f under its load: draft off by %.2g m\n", ratios[i], off);
        assert_true(off < 1e-3);
        assert_true(fabs(sim_y(w, load) - sim_y(w, raft) - 1) < 2e-3);
        plumb_world_destroy(w);
    }
}

//---- motion --------------------------------------------------------------------------------------

// Bobbing where nothing is lost: w^2 = rho g width / (m + lent). Period off, and energy after 50 of them.
static double heave_error(double ratio, double dt, int substeps, double *left)
{
    plumb_world *w = world_of(substeps);
    pool(w, &(plumb_material_desc){ .density = (plumb_real)RHO,
                                    .fluid = true,
                                    .no_drag = true,
                                    .no_skin_drag = true,
                                    .no_wave_drag = true });
    const double rest = 0.5 - ratio, a = 0.002, g = -(double)plumb_world_gravity(w).y;
    plumb_body box = sim_crate(w, 0, rest + a, 0.5, 0.5, solid(w, RHO * ratio));
    plumb_body_set_fixed_rotation(w, box, true);
    const double omega = sqrt(g / (2 * ratio)), period = 2 * SIM_PI / omega;
    double last = a, crossed = 0;
    int crossings = 0;
    for (int i = 1; crossings < 50; ++i) {
        sim_step(w, dt);
        const double y = sim_y(w, box) - rest;
        if (last > 0 && y <= 0) {
            ++crossings;
            crossed = (i - y / (y - last)) * dt;
        }
        last = y;
    }
    *left = hypot(last, sim_vy(w, box) / omega) / a;
    plumb_world_destroy(w);
    return fabs(crossed / (period * (crossings - 0.75)) - 1);
}

static void heave_is_that_of_the_mass_that_moves(void **state)
{
    (void)state;
    double error[3], left;
    for (int i = 0; i < 3; ++i) { // h w = 0.37, half, a quarter
        error[i] = heave_error(0.5, (1 / 60.0) / (1 << i) * 7, 1, &left);
        print_message("heave: period off by %.2g, amplitude %.4f of the first\n", error[i], left);
        assert_true(left > 0.9 && left < 1.1);
    }
    const double order = sim_order(error, 3);
    print_message("order %.2f\n", order);
    assert_true(order > 1.8);
    assert_true(error[2] < 2e-3);
    const double light = heave_error(0.05, 1 / 60.0, 4, &left);
    print_message("heave of 0.05: period off by %.2g, amplitude %.4f\n", light, left);
    assert_true(light < 3e-3);
}

// v = vt tanh(a t / vt), a = (m - m_w) g / (m + lent), vt^2 = 2 (m - m_w) g / (rho C 2/3 d).
static double sinking_error(double ratio, double dt)
{
    plumb_world *w = world_of(1);
    pool(w, &(plumb_material_desc){
                .density = (plumb_real)RHO, .fluid = true, .no_skin_drag = true, .drag = 1.5f });
    plumb_body disc = sim_ball(w, 0, ratio > 1 ? -5 : -390, 0.5, solid(w, RHO * ratio));
    const double area = SIM_PI / 4, g = (double)plumb_world_gravity(w).y, d = 1;
    const double pull = RHO * (ratio - 1) * area * g, sign = pull < 0 ? -1 : 1;
    const double a = fabs(pull) / (RHO * (ratio + 1) * area);
    const double vt = sqrt(2 * fabs(pull) / (RHO * 1.5 * 2 / 3 * d));
    double worst = 0;
    for (int i = 1; i * dt < 3; ++i) {
        sim_step(w, dt);
        worst = fmax(worst, fabs(sim_vy(w, disc) - sign * vt * tanh(a * i * dt / vt)) / vt);
    }
    for (int i = 0; i < 240; ++i) {
        sim_step(w, dt);
    }
    assert_true(fabs(sim_vy(w, disc) / (sign * vt) - 1) < 1e-4); // the same at any dt
    plumb_world_destroy(w);
    return worst;
}

static void speeds_go_to_the_terminal_one(void **state)
{
    (void)state;
    const double ratios[] = { 3, 0.5, 0.001 };
    for (int k = 0; k < 3; ++k) {
        double error[3];
        for (int i = 0; i < 3; ++i) {
            error[i] = sinking_error(ratios[k], (double)(plumb_real)(0.1 / (1 << i)));
        }
        print_message(
            "disc of %.3f: speed off by %.2g, %.2g, %.2g of the terminal one, order %.2f\n",
            ratios[k], error[0], error[1], error[2], sim_order(error, 3));
        assert_true(sim_order(error, 3) > 1.8);
    }
}

// v = v0 / (1 + k v0 t) and the way log(1 + k v0 t) / k, whatever the step.
static void drag_alone_is_exact(void **state)
{
    (void)state;
    const double steps[] = { 1 / 240.0, 1 / 60.0, 0.5 };
    for (int i = 0; i < 3; ++i) {
        const double dt = (double)(plumb_real)steps[i];
        plumb_world *w = sim_world(&(plumb_world_desc){ .zero_gravity = true, .no_sleep = true });
        pool(w, &(plumb_material_desc){ .density = (plumb_real)RHO,
                                        .fluid = true,
                                        .no_skin_drag = true,
                                        .no_added_mass = true });
        plumb_body box = sim_crate(w, 0, -50, 0.5, 0.5, solid(w, 1)); // a thousandth
        sim_launch(w, box, 10, 0, 0);
        const double k = RHO * 1.8 / 2 * 1 / 1.0;
        double worst = 0;
        for (int n = 1; n <= 100; ++n) {
            sim_step(w, dt);
            worst = fmax(worst, fabs(sim_vx(w, box) * (1 + k * 10 * n * dt) / 10 - 1));
        }
        print_message("drag at %.4f s: speed off by %.2g of it\n", dt, worst);
        assert_true(worst < SIM_TOLERANCE(4e-4, 1e-10));
        plumb_world_destroy(w);
    }
}

// Nothing is too light and no step too long: from above into the water, at rest in the end.
static void light_bodies_stay_calm(void **state)
{
    (void)state;
    const double steps[] = { 1 / 60.0, 1 / 10.0 };
    for (int i = 0; i < 2; ++i) {
        for (int k = 0; k < 4; ++k) {
            const double ratio = k % 2 ? 0.001 : 0.01, r = k < 2 ? 0.02 : 0.3;
            plumb_world *w = world_of(4);
            pool(w, &(plumb_material_desc){ .density = (plumb_real)RHO, .fluid = true });
            plumb_body box = sim_body(w, PLUMB_DYNAMIC, 0, 2, 0.4);
            sim_add_box(w, box, r, r, solid(w, RHO * ratio));
            sim_launch(w, box, 3, -10, 20);
            double fastest = 0, late = 0;
            for (double t = 0; t < 30; t += steps[i]) {
                sim_step(w, steps[i]);
                fastest = fmax(fastest, hypot(sim_vx(w, box), sim_vy(w, box)));
                late = t > 25 ? fmax(late, fabs(sim_vy(w, box))) : 0;
            }
            print_message("box of %.0f cm, %.3f, at %3.0f Hz: fastest %.2f m/s, at last %.2g m/s\n",
                          200 * r, ratio, 1 / steps[i], fastest, late);
            assert_true(fastest < 15 && late < 0.02);
            plumb_world_destroy(w);
        }
    }
}

// Who drifts goes with the flow; in a tank that moves, with the tank.
static void flows_carry(void **state)
{
    (void)state;
    plumb_world *w = sim_world(&(plumb_world_desc){ .no_sleep = true });
    pool(w, &(plumb_material_desc){ .density = (plumb_real)RHO, .fluid = true, .flow_x = 2 });
    plumb_body disc = sim_ball(w, 0, 0, 0.5, solid(w, 500));
    sim_run(w, 60 * 60, 1 / 60.0);
    print_message("drifts at %.4f m/s of 2\n", sim_vx(w, disc));
    assert_true(fabs(sim_vx(w, disc) - 2) < 0.02);
    plumb_world_destroy(w);

    w = sim_world(&(plumb_world_desc){ .no_sleep = true });
    plumb_body tank = pool(w, &(plumb_material_desc){ .density = (plumb_real)RHO, .fluid = true });
    plumb_body_set_type(w, tank, PLUMB_KINEMATIC);
    plumb_body_set_velocity(w, tank, sim_vec(1, 0.5));
    disc = sim_ball(w, 0, 0, 0.5, solid(w, 500));
    sim_run(w, 60 * 60, 1 / 60.0);
    print_message("in a tank: (%.4f, %.4f) m/s\n", sim_vx(w, disc), sim_vy(w, disc));
    assert_true(fabs(sim_vx(w, disc) - 1) < 0.02 && fabs(sim_vy(w, disc) - 0.5) < 0.02);
    plumb_world_destroy(w);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(drafts_are_exact),
        cmocka_unit_test(logs_float_flat_or_do_not),
        cmocka_unit_test(rafts_bear_their_load),
        cmocka_unit_test(heave_is_that_of_the_mass_that_moves),
        cmocka_unit_test(speeds_go_to_the_terminal_one),
        cmocka_unit_test(drag_alone_is_exact),
        cmocka_unit_test(light_bodies_stay_calm),
        cmocka_unit_test(flows_carry),
    };
    return cmocka_run_group_tests_name("fluids", tests, NULL, NULL);
}
