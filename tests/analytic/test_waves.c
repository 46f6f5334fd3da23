// test_waves.c - waves on water against linear theory: how they swing, what bodies make of them, what they make of bodies.
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "harness/near.h"
#include "harness/sim.h"
#include "harness/trials.h"

#define RHO 1000.0
#define G   10.0

typedef struct pool {
    plumb_world *w;
    plumb_shape shape;
    double width, depth;
} pool;

// Water from -width/2 to width/2, its surface at 0.
static pool make(double width, double depth, plumb_material_desc water, plumb_waves_desc waves,
                 int substeps)
{
    pool p = { .width = width, .depth = depth };
    p.w = sim_world(&(plumb_world_desc){
        .substeps = substeps, .no_sleep = true, .no_continuous = true, .gravity = sim_vec(0, -G) });
    water.fluid = true;
    water.density = (plumb_real)RHO;
    plumb_material m = plumb_material_create(p.w, &water);
    plumb_body holder = sim_body(p.w, PLUMB_STATIC, 0, -depth / 2, 0);
    p.shape = plumb_shape_create(p.w, holder,
                                 &(plumb_shape_desc){ .kind = PLUMB_BOX,
                                                      .half = sim_vec(width / 2, depth / 2),
                                                      .sensor = true,
                                                      .material = m });
    assert_int_equal(plumb_waves_create(p.w, p.shape, &waves), PLUMB_OK);
    return p;
}

static const plumb_material_desc ideal = { .no_drag = true, .no_skin_drag = true };

static plumb_body box(plumb_world *w, double x, double y, double hx, double hy, double density)
{
    plumb_body b = sim_body(w, PLUMB_DYNAMIC, x, y, 0);
    const plumb_shape_desc d = { .kind = PLUMB_BOX,
                                 .half = sim_vec(hx, hy),
                                 .density = (plumb_real)density };
    assert_false(plumb_is_null(plumb_shape_create(w, b, &d)));
    return b;
}

static double omega_of(double k, double depth)
{
    return sqrt(G * k * tanh(k * depth));
}

static plumb_wave_sample at(const pool *p, double x)
{
    return plumb_waves_at(p->w, p->shape, (plumb_real)x);
}

static void waves_swing_as_theory_has_it(void **state)
{
    (void)state;
    const double steps[] = { 1.0 / 240, 1.0 / 60, 0.1, 0.7 };
    for (int i = 0; i < 4; ++i) {
        pool p = make(12, 2, ideal, (plumb_waves_desc){ .no_damping = true }, 4);
        plumb_wave_mode modes[7] = { { 0, 0 } };
        modes[6] = (plumb_wave_mode){ 0.03, 0.05 };
        assert_int_equal(plumb_waves_set_modes(p.w, p.shape, modes, 7), PLUMB_OK);
        const double k = 7 * SIM_PI / 12, omega = omega_of(k, 2),
                     began = plumb_waves_energy(p.w, p.shape);
        double worst = 0, t = 0;
        for (int n = 0; n < 20 / steps[i]; ++n) {
            assert_int_equal(plumb_world_step(p.w, (plumb_real)steps[i]), PLUMB_OK);
            t += (double)(plumb_real)steps[i];
            const double h = 0.03 * cos(omega * t) + 0.05 / omega * sin(omega * t),
                         x = -6 + 1.3 * (n % 9);
            worst = fmax(worst, fabs((double)at(&p, x).height - h * cos(k * (x + 6))));
        }
        print_message("steps of %.4f s: off by %.2g m\n", steps[i], worst);
        assert_true(worst < SIM_TOLERANCE(1e-7, 1e-12));
        assert_near(plumb_waves_energy(p.w, p.shape), began, began * 1e-11);
        plumb_world_destroy(p.w);
    }
}

// [J] of a wide box of half of the water's density, a metre and a half across, that heaves and sways little, with the waves: body and
// what it carries along, less what the water would be that it displaces, which has the flow's velocity.
typedef struct balance {
    double body, water, waves;
} balance;

static double heaved(double step, double time, double amplitude, bool carries, balance *out)
{
    plumb_material_desc water = ideal;
    water.no_added_mass = !carries;
    pool p = make(40, 10, water, (plumb_waves_desc){ .modes = 256, .no_damping = true }, 4);
    plumb_body b = box(p.w, 0.01, amplitude, 1, 0.25, 500);
    const double began = RHO * G * 2 * amplitude * amplitude / 2;
    double worst = 0;
    for (int n = 0; n < (int)(time / step + 0.5); ++n) {
        assert_int_equal(plumb_world_step(p.w, (plumb_real)step), PLUMB_OK);
        const plumb_vec2 at = plumb_body_position(p.w, b), v = plumb_body_velocity(p.w, b);
        const double y = (double)at.y, area = 2 * (0.25 - y), lent = carries ? RHO * area : 0;
        const plumb_fluid_sample f =
            plumb_fluid_at(p.w, (plumb_vec2){ at.x, (plumb_real)((y - 0.25) / 2) });
        const double u = (double)f.velocity.x * (double)f.velocity.x +
                         (double)f.velocity.y * (double)f.velocity.y;
        const double square = (double)v.x * (double)v.x + (double)v.y * (double)v.y;
        *out = (balance){ (500 + lent) * square / 2 + RHO * G * 2 * y * y / 2,
                          (RHO * area + lent) * u / 2, plumb_waves_energy(p.w, p.shape) };
        worst = fmax(worst, fabs((out->body - out->water + out->waves) / began - 1));
    }
    out->waves /= began;
    plumb_world_destroy(p.w);
    return worst;
}

static void what_a_body_loses_waves_have(void **state)
{
    (void)state;
    for (int carries = 0; carries < 2; ++carries) {
        for (int hz = 60; hz <= 240; hz *= 4) {
            balance b = { 0, 0, 0 };
            const double worst = heaved(1.0 / hz, 6, 0.01, carries, &b);
            print_message("%s, %d Hz: the sum is off by %.3f, waves have %.3f of it\n",
                          carries ? "with what it carries along" : "alone", hz, worst, b.waves);
            assert_true(worst < 0.15); // the flow is asked at one place of the body alone
            assert_true(b.waves > 0.3 && b.waves < 1);
        }
    }
}

// A kinematic box that heaves slowly sends out waves of k B e^(-k draft) sin(k B / 2) / (k B / 2) times its amplitude: k B for
// long ones (Ursell 1949). Seen 12 m off, before the walls answer.
static void a_wavemaker_makes_the_waves_of_theory(void **state)
{
    (void)state;
    const double omegas[] = { 1.5, 2, 2.5 };
    for (int i = 0; i < 3; ++i) {
        const double omega = omegas[i], k = omega * omega / G, B = 1, draft = 0.3, a = 0.01;
        plumb_material_desc water = ideal;
        water.no_added_mass = true;
        pool p = make(160, 60, water, (plumb_waves_desc){ .modes = 512, .no_damping = true }, 4);
        plumb_body b = sim_body(p.w, PLUMB_KINEMATIC, 0, 0.2, 0);
        plumb_shape_create(p.w, b,
                           &(plumb_shape_desc){ .kind = PLUMB_BOX, .half = sim_vec(B / 2, 0.5) });
        const double h = 1.0 / 60, speed = G / omega / 2;
        const double ready = 12 / speed + 4 * 2 * SIM_PI / omega;
        double high = 0;
        for (int n = 0; n * h < ready + 2 * SIM_PI / omega; ++n) {
            // On slowly, so that nothing but its own frequency is made.
            const double on = fmin(1, n * h * omega / (4 * SIM_PI));
            plumb_body_set_velocity(p.w, b, sim_vec(0, on * a * omega * cos(omega * n * h)));
            plumb_world_step(p.w, (plumb_real)h);
            high = n * h > ready ? fmax(high, fabs((double)at(&p, 12).height)) : 0;
        }
        const double half = k * B / 2, theory = k * B * exp(-k * draft) * sin(half) / half;
        print_message("k B %.3f: %.4f of the amplitude, theory %.4f\n", k * B, high / a, theory);
        assert_near(high / a, theory,
                    (i == 0 ? 0.05 : 0.15) * theory); // it is in its own waves, too
        plumb_world_destroy(p.w);
    }
}

// A small disc as heavy as water goes round as the water does, by e^(kz) less the deeper it is.
static void what_is_as_dense_as_water_goes_round(void **state)
{
    (void)state;
    const double width = 40, depth = 15, k = SIM_PI * 8 / width, a = 0.005;
    for (int i = 0; i < 2; ++i) {
        pool p = make(width, depth, ideal,
                      (plumb_waves_desc){ .modes = 1,
                                          .no_damping = true,
                                          .swell = (plumb_real)a,
                                          .swell_length = (plumb_real)(2 * SIM_PI / k) },
                      4);
        const double z = i == 0 ? -1 : -2.5, omega = omega_of(k, depth), r = a * exp(k * z);
        plumb_body b = sim_body(p.w, PLUMB_DYNAMIC, 0, z, 0);
        plumb_material m = plumb_material_create(p.w, &(plumb_material_desc){ .density = RHO });
        plumb_shape_create(
            p.w, b,
            &(plumb_shape_desc){ .kind = PLUMB_CIRCLE, .radius = (plumb_real)0.05, .material = m });
        // At the left end, which is x = -20: k x = -4 pi, so the phase there is that at 0.
        plumb_body_set_velocity(p.w, b, sim_vec(omega * r, 0));
        double low_x = 0, high_x = 0, low_y = z, high_y = z;
        for (int n = 0; n < (int)(2 * SIM_PI / omega * 60); ++n) {
            plumb_world_step(p.w, (plumb_real)(1.0 / 60));
            const plumb_vec2 q = plumb_body_position(p.w, b);
            low_x = fmin(low_x, (double)q.x), high_x = fmax(high_x, (double)q.x);
            low_y = fmin(low_y, (double)q.y), high_y = fmax(high_y, (double)q.y);
        }
        print_message("at %.1f m: %.5f by %.5f m, theory %.5f\n", z, high_x - low_x, high_y - low_y,
                      2 * r);
        assert_near(high_x - low_x, 2 * r, 0.03 * r);
        assert_near(high_y - low_y, 2 * r, 0.03 * r);
        plumb_world_destroy(p.w);
    }
}

// It goes up and down with a long wave, and is as deep in it as in still water but for its own inertia: 4 % of the swell.
static void what_is_small_rides(void **state)
{
    (void)state;
    pool p = make(60, 20, (plumb_material_desc){ 0 },
                  (plumb_waves_desc){
                      .modes = 1, .swell = (plumb_real)0.4, .swell_length = -30, .height = 1 },
                  4);
    plumb_body b = box(p.w, 3, 0, 0.2, 0.1, 500);
    double worst = 0;
    for (int n = 0; n < 1200; ++n) {
        plumb_world_step(p.w, (plumb_real)(1.0 / 60));
        const plumb_vec2 q = plumb_body_position(p.w, b);
        if (n > 300) {
            worst = fmax(worst, fabs((double)q.y - (double)at(&p, (double)q.x).height));
        }
    }
    print_message("off the surface by %.4f m at the most\n", worst);
    assert_true(worst < 0.04);
    plumb_world_destroy(p.w);
}

// At rest waves change no draft, nor does the body anything to them.
static void still_water_stays_still(void **state)
{
    (void)state;
    pool p = make(20, 4, (plumb_material_desc){ 0 }, (plumb_waves_desc){ 0 }, 4);
    plumb_body b = box(p.w, 2, -0.25 + 0.5, 1, 0.5, 250);
    for (int n = 0; n < 600; ++n) {
        plumb_world_step(p.w, (plumb_real)(1.0 / 60));
    }
    assert_near((double)plumb_body_position(p.w, b).y, 0.25, 1e-5);
    assert_true(plumb_waves_energy(p.w, p.shape) < 1e-4);
    plumb_world_destroy(p.w);
}

// Boxes and discs of any size and density, thrown in at any step: the water never has more than they had, and they float as deep
// as in still water in the end.
static void splashes_take_no_more_than_falls_give(void **state)
{
    (void)state;
    uint32_t seed = 7;
    double most = 0;
    const int count = (int)trials_count(20);
    for (int i = 0; i < count; ++i) {
        const double density = pow(10, sim_uniform(&seed, 0, 2.95)),
                     r = pow(10, sim_uniform(&seed, -1.7, 0));
        const double h = 1 / sim_uniform(&seed, 25, 240), fall = sim_uniform(&seed, 0.5, 6);
        pool p = make(24, 12, (plumb_material_desc){ 0 },
                      (plumb_waves_desc){ .modes = 64, .damping = 1 }, 4);
        plumb_body b = sim_body(p.w, PLUMB_DYNAMIC, sim_uniform(&seed, -9, 9), fall + r,
                                sim_uniform(&seed, 0, 3));
        plumb_shape_create(
            p.w, b,
            &(plumb_shape_desc){ .kind = i % 2 == 0 ? PLUMB_BOX : PLUMB_CIRCLE,
                                 .half = sim_vec(i % 2 == 0 ? r : 0, i % 2 == 0 ? r : 0),
                                 .radius = (plumb_real)(i % 2 == 0 ? 0 : r),
                                 .density = (plumb_real)density });
        const double mass = (double)plumb_body_mass(p.w, b), had = mass * G * fall;
        double top = 0;
        for (double t = 0; t < 40; t += h) {
            assert_int_equal(plumb_world_step(p.w, (plumb_real)h), PLUMB_OK);
            top = fmax(top, plumb_waves_energy(p.w, p.shape));
        }
        most = fmax(most, top / had);
        const plumb_vec2 v = plumb_body_velocity(p.w, b), q = plumb_body_position(p.w, b);
        assert_true(top < had);
        assert_true(hypot((double)v.x, (double)v.y) < 0.2 && fabs((double)q.y) < r + 0.05);
        plumb_world_destroy(p.w);
    }
    print_message("at most %.2f of what fell\n", most);
}

// The mirror image of a scene, and one with y downwards, are the scene mirrored.
static void mirrored_water_is_the_same(void **state)
{
    (void)state;
    double x[3][2];
    for (int i = 0; i < 3; ++i) {
        const double mx = i == 1 ? -1 : 1, my = i == 2 ? -1 : 1;
        pool p = make(16, 3, (plumb_material_desc){ 0 }, (plumb_waves_desc){ .modes = 48 }, 4);
        if (my < 0) {
            plumb_world_set_gravity(p.w, sim_vec(0, G));
            plumb_body holder = plumb_shape_body(p.w, p.shape);
            plumb_body_set_position(p.w, holder, sim_vec(0, 1.5));
        }
        plumb_body b = box(p.w, 2.3 * mx, 1.6 * my, 0.6, 0.3, 400),
                   c = box(p.w, 0.4 * mx, 0, 1, 0.2, 500);
        plumb_body_set_angular_velocity(p.w, b, (plumb_real)(1.1 * mx * my));
        for (int n = 0; n < 120; ++n) {
            plumb_world_step(p.w, (plumb_real)(1.0 / 60));
        }
        const plumb_vec2 q = plumb_body_position(p.w, b), s = plumb_body_position(p.w, c);
        x[i][0] = mx * (double)q.x + my * (double)q.y;
        x[i][1] = mx * (double)s.x + my * (double)s.y;
        plumb_world_destroy(p.w);
    }
    for (int i = 1; i < 3; ++i) {
        print_message("off by %.2g, %.2g m\n", fabs(x[i][0] - x[0][0]), fabs(x[i][1] - x[0][1]));
        assert_near(x[i][0], x[0][0], SIM_TOLERANCE(1e-3, 1e-9));
        assert_near(x[i][1], x[0][1], SIM_TOLERANCE(1e-3, 1e-9));
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(waves_swing_as_theory_has_it),
        cmocka_unit_test(what_a_body_loses_waves_have),
        cmocka_unit_test(a_wavemaker_makes_the_waves_of_theory),
        cmocka_unit_test(what_is_as_dense_as_water_goes_round),
        cmocka_unit_test(what_is_small_rides),
        cmocka_unit_test(still_water_stays_still),
        cmocka_unit_test(splashes_take_no_more_than_falls_give),
        cmocka_unit_test(mirrored_water_is_the_same),
    };
    return cmocka_run_group_tests_name("waves on water", tests, NULL, NULL);
}
