// test_local_flow.c - fluids that flow another way at each place, against closed forms: vortices, sources, jets, eddies, and what
// they do to bodies.
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

// A volume of a fluid, 400 m wide, about the origin of a body at (x, y).
static plumb_body volume(plumb_world *w, double x, double y, double angle, plumb_material_desc desc)
{
    desc.fluid = desc.no_skin_drag = true;
    plumb_material m = plumb_material_create(w, &desc);
    plumb_body holder = sim_body(w, PLUMB_STATIC, x, y, angle);
    const plumb_shape_desc shape = {
        .kind = PLUMB_BOX, .half = sim_vec(200, 200), .sensor = true, .material = m
    };
    assert_false(plumb_is_null(plumb_shape_create(w, holder, &shape)));
    return holder;
}

static plumb_body wind(plumb_world *w, double x, double y, double angle, plumb_material_desc desc)
{
    desc.density = (plumb_real)RHO;
    desc.weightless = true;
    return volume(w, x, y, angle, desc);
}

static plumb_world *space(int substeps)
{
    return sim_world(&(plumb_world_desc){
        .substeps = substeps, .no_sleep = true, .zero_gravity = true, .no_continuous = true });
}

static plumb_material solid(plumb_world *w, double density)
{
    return plumb_material_create(w, &(plumb_material_desc){ .density = (plumb_real)density });
}

static void flow(plumb_world *w, double x, double y, double out[2])
{
    const plumb_fluid_sample s = plumb_fluid_at(w, sim_vec(x, y));
    assert_false(plumb_is_null(s.shape));
    out[0] = (double)s.velocity.x;
    out[1] = (double)s.velocity.y;
}

//---- the flow ------------------------------------------------------------------------------------

// Lamb and Oseen: the fastest at 1.12091 core radii, where it has 0.638173 of swirl / (2 pi core).
static void vortices_and_sources_have_their_circulation(void **state)
{
    (void)state;
    plumb_world *w = space(4);
    wind(w, 3, -2, 1, (plumb_material_desc){ .swirl = 20, .outflow = -7, .core_radius = 2 });
    double worst = 0;
    for (int i = 0; i < 60; ++i) {
        const double r = 0.01 * pow(1.2, i) < 150 ? 0.01 * pow(1.2, i) : 150, at = 0.7 * i;
        const double share = (1 - exp(-r * r / 4)) / (2 * SIM_PI * r);
        double u[2];
        flow(w, 3 + r * cos(at), -2 + r * sin(at), u);
        const double round = u[1] * cos(at) - u[0] * sin(at), out = u[0] * cos(at) + u[1] * sin(at);
        worst = fmax(worst, fmax(fabs(round - 20 * share), fabs(out + 7 * share)));
    }
    double peak[2];
    flow(w, 3 + 2 * 1.1209064, -2, peak);
    print_message("worst %.2g m/s, peak %.6f\n", worst, peak[1]);
    assert_true(worst < SIM_TOLERANCE(1e-5, 1e-13));
    assert_near(peak[1], 20 / (2 * SIM_PI * 2) * 0.6381726863389, 1e-5);
    plumb_world_destroy(w);
}

// What it carries of momentum is that of the slot at each x; far off it is half as fast at 0.11 x.
static void jets_keep_their_momentum(void **state)
{
    (void)state;
    for (int turned = 0; turned < 2; ++turned) {
        plumb_world *w = space(4);
        const double angle = turned ? 2.1 : 0, c = cos(angle), s = sin(angle);
        wind(w, 1, 1, angle,
             (plumb_material_desc){ .jet = turned ? -9 : 9, .jet_width = (plumb_real)0.5 });
        const double way = turned ? -1 : 1, places[] = { 0.02, 0.5, 2.9, 3.1, 10, 60 };
        for (int i = 0; i < 6; ++i) {
            const double x = places[i], width = 0.5 + x, step = width / 2000;
            double momentum = 0, half = 0, axis = 0;
            for (int k = -2000; k < 2000; ++k) {
                const double y = (k + 0.5) * step;
                double u[2];
                flow(w, 1 + way * (c * x - s * y), 1 + way * (s * x + c * y), u);
                const double speed = way * (c * u[0] + s * u[1]);
                assert_true(fabs(c * u[1] - s * u[0]) < 1e-5);
                momentum += speed * speed * step;
                axis = fmax(axis, speed);
                half += speed > axis / 2 && y > 0 ? step : 0;
            }
            print_message("at %5.2f m: %.5f of the momentum, axis %.3f m/s, half at %.4f x\n", x,
                          momentum / (81 * 0.5), axis, half / x);
            assert_near(momentum, 81 * 0.5, x < 0.1 ? 0.2 : 0.01);
            if (x > 3) {
                assert_near(half / x, 0.11, 0.002);
                assert_near(axis, 9 * sqrt(6 * 0.5 / x), 0.01);
            }
        }
        double u[2];
        flow(w, 1 - way * c, 1 - way * s, u);
        assert_true(u[0] == 0 && u[1] == 0); // nothing behind it
        plumb_world_destroy(w);
    }
}

// Their root mean square is what it is said to be, the same in all directions; what comes in goes out; they change in time.
static void eddies_are_isotropic_and_free_of_divergence(void **state)
{
    (void)state;
    plumb_world *w = space(4);
    wind(w, 0, 0, 0, (plumb_material_desc){ .eddies = 3, .eddy_length = 8 });
    uint32_t rng = 7;
    double xx = 0, yy = 0, xy = 0, gradient = 0, divergence = 0;
    const int count = 4000;
    const double d = SIM_TOLERANCE(0.02, 1e-4);
    for (int i = 0; i < count; ++i) {
        const double x = sim_uniform(&rng, -180, 180), y = sim_uniform(&rng, -180, 180);
        double u[2], a[2], b[2], e[2], f[2];
        flow(w, x, y, u);
        xx += u[0] * u[0] / count, yy += u[1] * u[1] / count, xy += u[0] * u[1] / count;
        flow(w, x + d, y, a), flow(w, x - d, y, b);
        flow(w, x, y + d, e), flow(w, x, y - d, f);
        const double ux = (a[0] - b[0]) / (2 * d), vy = (e[1] - f[1]) / (2 * d);
        gradient += ux * ux / count;
        divergence += (ux + vy) * (ux + vy) / count;
    }
    print_message(
        "root mean squares %.3f, %.3f m/s, mean product %.3f; divergence %.2g of %.3g /s\n",
        sqrt(xx), sqrt(yy), xy, sqrt(divergence), sqrt(gradient));
    assert_near(sqrt(xx + yy), 3, 0.06);
    assert_near(xx / yy, 1, 0.2);
    assert_true(fabs(xy) < 0.05 * 9);
    assert_true(sqrt(divergence) < 3e-3 * sqrt(gradient));
    double before[2], behind[2];
    flow(w, 1, 2, before);
    sim_run(w, 60, 1 / 60.0);
    flow(w, 1, 2, behind);
    assert_true(hypot(behind[0] - before[0], behind[1] - before[1]) > 0.3);
    plumb_world_destroy(w);
}

// They pass with the flow: what they are at a place, they are a time later where the flow has gone.
static void volumes_carry_their_flow_along(void **state)
{
    (void)state;
    plumb_world *w = space(4);
    plumb_body holder =
        wind(w, 0, 0, 0,
             (plumb_material_desc){ .swirl = 5, .flow_x = 2, .core_radius = (plumb_real)0.5 });
    plumb_body_set_type(w, holder, PLUMB_KINEMATIC);
    plumb_body_set_velocity(w, holder, sim_vec(3, 0));
    plumb_body_set_angular_velocity(w, holder, 0);
    sim_run(w, 60, 1 / 64.0);
    double u[2];
    flow(w, 3 * 60 / 64.0 + 1, 0, u);
    assert_near(u[0], 5, 1e-5); // that of the body and the flow
    assert_near(u[1], 5 * (1 - exp(-4)) / (2 * SIM_PI), 1e-5);
    plumb_world_destroy(w);
}

//---- what it does to bodies ----------------------------------------------------------------------

// A rod held in the middle of a vortex: its ends go as fast as the fluid there, swirl / (2 pi core^2) for a short one.
static void what_is_small_turns_with_the_vortex(void **state)
{
    (void)state;
    const double reach[] = { 0.4, 0.2, 0.1 };
    double error[3];
    for (int i = 0; i < 3; ++i) {
        plumb_world *w = space(4);
        wind(w, 0, 0, 0, (plumb_material_desc){ .swirl = 20, .core_radius = 1 });
        plumb_body rod = sim_crate(w, 0, 0, reach[i], reach[i] / 40, solid(w, 0.1));
        for (int k = 0; k < 600; ++k) {
            plumb_body_set_position(w, rod, sim_vec(0, 0));
            plumb_body_set_velocity(w, rod, sim_vec(0, 0));
            sim_step(w, 1 / 60.0);
        }
        error[i] = fabs(sim_w(w, rod) / (20 / (2 * SIM_PI)) - 1);
        plumb_world_destroy(w);
    }
    print_message("rods of 0.4, 0.2, 0.1 m: slower than the middle by %.2g, %.2g, %.2g\n", error[0],
                  error[1], error[2]);
    assert_true(error[2] < 0.006 && sim_order(error, 3) > 1.9);
}

// A board as broad as the jet and more bears rho C / 2 times all of its momentum, near the slot and far from it.
static void a_board_bears_all_of_a_jet(void **state)
{
    (void)state;
    const double places[] = { 0.2, 1, 3, 6 };
    for (int i = 0; i < 4; ++i) {
        plumb_world *w = space(1);
        wind(w, 0, 0, 0, (plumb_material_desc){ .jet = 10, .jet_width = (plumb_real)0.5 });
        plumb_body board = sim_crate(w, places[i] + 0.05, 0.1, 0.05, 2, solid(w, 1000));
        sim_step(w, 1e-3);
        const double force = sim_vx(w, board) / 1e-3 * 1000 * 0.4, all = RHO * C / 2 * 100 * 0.5;
        print_message("at %.1f m: %.4f of what it bears\n", places[i], force / all);
        assert_near(force / all, 1, places[i] < 2 ? 0.04 : 0.005);
        plumb_world_destroy(w);
    }
}

// What is as dense as the water goes round with it, on a circle, for the pressure holds it; order two in the step.
static void what_floats_stays_on_its_circle(void **state)
{
    (void)state;
    double error[3];
    for (int i = 0; i < 3; ++i) {
        plumb_world *w = space(1);
        volume(w, 0, 0, 0,
               (plumb_material_desc){
                   .density = 1000, .no_drag = true, .swirl = 10, .core_radius = 1 });
        plumb_body ball = sim_ball(w, 2, 0, 0.05, solid(w, 1000));
        double u[2];
        flow(w, 2, 0, u);
        sim_launch(w, ball, 0, u[1], 0);
        const double dt = 1.0 / (32 << i);
        sim_run(w, 10 * (32 << i), dt);
        error[i] = fabs(hypot(sim_x(w, ball), sim_y(w, ball)) - 2);
        plumb_world_destroy(w);
    }
    print_message("off its circle after 10 s by %.2g, %.2g, %.2g m, order %.2f\n", error[0],
                  error[1], error[2], sim_order(error, 3));
    assert_true(error[2] < 1e-3 && sim_order(error, 3) > 1.8);
}

// A ball over a jet that blows up floats where the axis has the ball's terminal speed.
static void a_jet_carries_a_ball(void **state)
{
    (void)state;
    plumb_world *w = sim_world(&(plumb_world_desc){ .no_sleep = true });
    wind(w, 0, 0, SIM_PI / 2, (plumb_material_desc){ .jet = 12, .jet_width = 1 });
    plumb_body ball = sim_ball(w, 0, 7, 0.05, solid(w, 40));
    sim_run(w, 60 * 40, 1 / 60.0);
    // rho C / 2 (2/3) 2 r u^2 = m g
    const double mass = 40 * SIM_PI * 0.05 * 0.05,
                 u = sqrt(mass * SIM_G / (RHO * C / 2 * 2 / 3.0 * 0.1));
    const double height = 6 * 144 / (u * u);
    print_message("floats at %.4f m, of %.4f; %.2g m aside\n", sim_y(w, ball), height,
                  sim_x(w, ball));
    assert_near(sim_y(w, ball), height, 0.02);
    assert_near(sim_vy(w, ball), 0, 5e-3);
    plumb_world_destroy(w);
}

// Turned worlds are turned copies.
static void any_direction_is_the_same(void **state)
{
    (void)state;
    double at[4][2];
    for (int i = 0; i < 4; ++i) {
        plumb_world *w = space(4);
        const double angle = 0.9 * i, c = cos(angle), s = sin(angle);
        wind(w, 0, 0, angle,
             (plumb_material_desc){ .swirl = 6, .outflow = 2, .jet = 5, .jet_width = 1 });
        plumb_body b =
            sim_body(w, PLUMB_DYNAMIC, c * 1.5 - s * 0.4, s * 1.5 + c * 0.4, angle + 0.3);
        sim_add_box(w, b, 0.7, 0.2, solid(w, 2));
        sim_run(w, 90, 1 / 60.0);
        at[i][0] = c * sim_x(w, b) + s * sim_y(w, b);
        at[i][1] = c * sim_y(w, b) - s * sim_x(w, b);
        assert_near(at[i][0], at[0][0], SIM_TOLERANCE(2e-3, 1e-9));
        assert_near(at[i][1], at[0][1], SIM_TOLERANCE(2e-3, 1e-9));
        plumb_world_destroy(w);
    }
    assert_true(hypot(at[0][0] - 1.5, at[0][1] - 0.4) > 0.5);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(vortices_and_sources_have_their_circulation),
        cmocka_unit_test(jets_keep_their_momentum),
        cmocka_unit_test(eddies_are_isotropic_and_free_of_divergence),
        cmocka_unit_test(volumes_carry_their_flow_along),
        cmocka_unit_test(what_is_small_turns_with_the_vortex),
        cmocka_unit_test(a_board_bears_all_of_a_jet),
        cmocka_unit_test(what_floats_stays_on_its_circle),
        cmocka_unit_test(a_jet_carries_a_ball),
        cmocka_unit_test(any_direction_is_the_same),
    };
    return cmocka_run_group_tests_name("fluids that flow another way at each place", tests, NULL,
                                       NULL);
}
