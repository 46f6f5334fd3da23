// test_liquid_tension.c - surface tension of the liquid against closed forms: drops and pools at rest, waves of drops (Rayleigh) and of
// pools, squares that turn into drops, drops that merge.
// PLUMB_LONG
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "harness/near.h"
#include "harness/sim.h"
#include "harness/tank.h"
#include "harness/trials.h"

#define HZ60    (1 / 60.0)
#define DENSITY 1000.0

static plumb_world *make_space(double spacing, double tension)
{
    plumb_world *w = sim_space();
    assert_int_equal(plumb_liquid_create(w, &(plumb_liquid_desc){ .spacing = (plumb_real)spacing,
                                                                  .tension = (plumb_real)tension }),
                     PLUMB_OK);
    return w;
}

// r = radius (1 + share cos(mode angle)) about (x, y).
static void add_drop(plumb_world *w, double x, double y, double radius, int mode, double share)
{
    plumb_vec2 outline[256];
    for (int i = 0; i < 256; ++i) {
        const double a = 2 * SIM_PI * i / 256, r = radius * (1 + share * cos(mode * a));
        outline[i] = sim_vec(x + r * cos(a), y + r * sin(a));
    }
    assert_int_equal(plumb_liquid_add_shape(w, outline, 256, NULL), PLUMB_OK);
}

typedef struct look {
    double x, y, u, v, turn; // mean place, velocity; angular momentum a particle
    double inner;            // rms speed but for the mean velocity
    double farthest;         // from the mean place
    double mode;             // share of a mode
} look;

static look look_at(const plumb_world *w, int mode, double radius)
{
    int count;
    look a = { 0 };
    const plumb_particle *p = plumb_liquid_particles(w, &count);
    for (int i = 0; i < count; ++i) {
        a.x += (double)p[i].position.x / count, a.y += (double)p[i].position.y / count;
        a.u += (double)p[i].velocity.x / count, a.v += (double)p[i].velocity.y / count;
    }
    for (int i = 0; i < count; ++i) {
        const double x = (double)p[i].position.x - a.x, y = (double)p[i].position.y - a.y;
        const double u = (double)p[i].velocity.x - a.u, v = (double)p[i].velocity.y - a.v;
        const double r = sqrt(x * x + y * y);
        a.inner += (u * u + v * v) / count;
        a.turn += (x * v - y * u) / count;
        a.farthest = fmax(a.farthest, r);
        a.mode += pow(r / radius, mode) * cos(mode * atan2(y, x)) / count;
    }
    a.inner = sqrt(a.inner);
    return a;
}

static double wave_speed(double tension, double radius)
{
    return sqrt(tension / (DENSITY * radius));
}

//---- at rest -------------------------------------------------------------------------------------

// Drops of 6 to 30 cells across anywhere in the cells; tensions up to what eight parts of a step can follow.
static void drops_rest(void **state)
{
    (void)state;
    const struct {
        double radius, spacing, x, y, tension, hz, most;
    } cases[] = {
        { 0.3, 0.05, 0.013, 0.021, 100, 60, 0.04 },  { 0.5, 0.05, 0.3, 0.11, 30, 60, 0.02 },
        { 1, 0.05, 0.017, 0.043, 400, 60, 0.015 },   { 1, 0.05, 0.3, 0.22, 3000, 60, 0.02 },
        { 1.5, 0.05, 0.033, 0.21, 1000, 60, 0.01 },  { 1, 0.025, 0.003, 0.001, 300, 60, 0.005 },
        { 1, 0.025, 0.3, 0.011, 10, 60, 0.01 },      { 1, 0.05, 0.3, 0.011, 10, 240, 0.015 },
        { 1, 0.05, 0.017, 0.043, 20000, 60, 0.015 },
    };
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; ++i) {
        if (!trials_takes((uint32_t)i, 3)) {
            continue;
        }
        plumb_world *w = make_space(cases[i].spacing, cases[i].tension);
        add_drop(w, cases[i].x, cases[i].y, cases[i].radius, 2, 0);
        sim_run(w, (int)(30 * cases[i].hz), 1 / cases[i].hz);
        const look a = look_at(w, 2, cases[i].radius);
        const double wave = wave_speed(cases[i].tension, cases[i].radius);
        const double sway = sqrt(a.u * a.u + a.v * a.v) / wave;
        print_message("a drop of %.0f cells, %g N/m, %g Hz after 30 s: rms %.2g of its waves' "
                      "speed, as a whole %.2g; farthest %.3f radii\n",
                      cases[i].radius / cases[i].spacing, cases[i].tension, cases[i].hz,
                      a.inner / wave, sway, a.farthest / cases[i].radius);
        assert_true(a.inner / wave < cases[i].most);
        assert_true(sway < 1e-4);
        assert_true(a.farthest < cases[i].radius + 3 * cases[i].spacing);
        plumb_world_destroy(w);
    }
}

// Without gravity the surface is as level as it began.
static void pools_rest(void **state)
{
    (void)state;
    plumb_world *w = tank_make(2, 2, 0.05);
    assert_int_equal(plumb_liquid_set(w, &(plumb_liquid_desc){ .tension = 100 }), PLUMB_OK);
    tank_fill(w, 0, 0, 2, 1);
    sim_run(w, 600, HZ60);
    const tank_state a = tank_look(w);
    print_message("a pool after 10 s: mean height off by %.2g m, rms %.2g m/s\n", a.mean_y - 0.5,
                  a.rms);
    assert_near(a.mean_y, 0.5, 1e-4);
    assert_true(a.rms < 1e-4);
    plumb_world_destroy(w);
}

//---- waves ---------------------------------------------------------------------------------------

// The period of a mode over three half ones, over that of theory.
static double drop_period(double spacing, int mode)
{
    const double tension = 100, hz = 60;
    plumb_world *w = make_space(spacing, tension);
    add_drop(w, 0.013, 0.031, 1, mode, 0.04);
    double before = 0, first = 0, last = 0;
    int crossings = 0;
    for (int n = 1; crossings < 4; ++n) {
        assert_true(n < 60 * hz);
        sim_run(w, 1, 1 / hz);
        const double share = look_at(w, mode, 1).mode;
        if (n > 1 && (before > 0) != (share > 0)) {
            last = n / hz - fabs(share) / (fabs(share) + fabs(before)) / hz;
            first = crossings++ == 0 ? last : first;
        }
        before = share;
    }
    plumb_world_destroy(w);
    const double omega = sqrt(mode * (mode * mode - 1.0) * tension / DENSITY);
    return 2 * (last - first) / 3 * omega / (2 * SIM_PI);
}

static void drops_swing_as_rayleigh_says(void **state)
{
    (void)state;
    const double most[] = { 0.03, 0.05, 0.09 };
    for (int mode = 2; mode <= 4; ++mode) {
        if (!trials_takes((uint32_t)mode, 3)) {
            continue;
        }
        const double coarse = drop_period(0.05, mode), fine = drop_period(0.025, mode);
        print_message("mode %d: period %.4f of theory with 20 cells across, %.4f with 40: order "
                      "%.1f\n",
                      mode, coarse, fine, log2((coarse - 1) / (fine - 1)));
        assert_near(coarse, 1, most[mode - 2]);
        assert_near(fine, 1, 0.03);
        assert_true(fabs(fine - 1) < 0.8 * fabs(coarse - 1));
    }
}

// Standing waves in a tank: omega^2 = (g k + tension k^3 / density) tanh(k H), half of it by tension.
static double pool_period(double spacing, double gravity, double tension)
{
    const double width = 2, depth = 1, k = 2 * SIM_PI / width, hz = 120;
    plumb_world *w = tank_make(width, 2, spacing);
    plumb_world_set_gravity(w, sim_vec(0, -gravity));
    assert_int_equal(plumb_liquid_set(w, &(plumb_liquid_desc){ .tension = (plumb_real)tension }),
                     PLUMB_OK);
    for (double y = spacing / 2; y < depth; y += spacing) {
        for (double x = spacing / 2; x < width; x += spacing) {
            const double speed = 0.1 / sinh(k * depth);
            const plumb_particle p = { .position = sim_vec(x, y),
                                       .velocity = sim_vec(-speed * cosh(k * y) * sin(k * x),
                                                           speed * sinh(k * y) * cos(k * x)) };
            assert_int_equal(plumb_liquid_add(w, &p, 1), PLUMB_OK);
        }
    }
    double before = 0, first = 0, last = 0;
    int crossings = 0;
    for (int n = 1; crossings < 4; ++n) {
        int count;
        double share = 0;
        assert_true(n < 60 * hz);
        sim_run(w, 1, 1 / hz);
        const plumb_particle *p = plumb_liquid_particles(w, &count);
        for (int i = 0; i < count; ++i) {
            share += (double)p[i].position.y * cos(k * (double)p[i].position.x);
        }
        if (n > 1 && (before > 0) != (share > 0)) {
            last = n / hz - fabs(share) / (fabs(share) + fabs(before)) / hz;
            first = crossings++ == 0 ? last : first;
        }
        before = share;
    }
    plumb_world_destroy(w);
    const double omega = sqrt((gravity * k + tension * k * k * k / DENSITY) * tanh(k * depth));
    return 2 * (last - first) / 3 * omega / (2 * SIM_PI);
}

static void pools_swing_by_tension_and_gravity(void **state)
{
    (void)state;
    const double gravity[] = { 0, 0.2, 0 }, tension[] = { 100, 100, 20 };
    for (int i = 0; i < 3; ++i) {
        if (!trials_takes((uint32_t)i, 3)) {
            continue;
        }
        const double coarse = pool_period(0.05, gravity[i], tension[i]);
        const double fine = pool_period(0.025, gravity[i], tension[i]);
        print_message("waves of 2 m, %g m/s^2, %g N/m: period %.4f of theory with 20 cells a wave, "
                      "%.4f with 40\n",
                      gravity[i], tension[i], coarse, fine);
        assert_near(coarse, 1, 0.06);
        assert_near(fine, 1, 0.04);
    }
}

//---- what it does --------------------------------------------------------------------------------

// A square becomes a drop; what it was keeps its momentum, and no more moves than the length of the surface held.
static void squares_become_drops(void **state)
{
    (void)state;
    const double tension = 300, side = 2, hz = 60;
    plumb_world *w = make_space(0.05, tension);
    assert_int_equal(plumb_liquid_add_box(w, sim_vec(-1, -1), sim_vec(1, 1), NULL), PLUMB_OK);
    const double radius = side / sqrt(SIM_PI);
    const double held = tension * (4 * side - 2 * SIM_PI * radius), mass = DENSITY * side * side;
    double most = 0, farthest = 0;
    for (int n = 0; n < 60 * hz; ++n) {
        sim_run(w, 1, 1 / hz);
        const look a = look_at(w, 4, radius);
        most = fmax(most, mass * a.inner * a.inner / 2);
        farthest = a.farthest;
        assert_true(mass * sqrt(a.u * a.u + a.v * a.v) < 1e-4 * mass * wave_speed(tension, radius));
        assert_true(fabs(a.turn) < 0.02 * radius * wave_speed(tension, radius));
    }
    print_message("a square: at most %.2f of what its surface held moves; after 60 s its farthest "
                  "particle is at %.3f radii\n",
                  most / held, farthest / radius);
    assert_true(most < held && most > 0.3 * held);
    assert_near(farthest, radius, 0.06 * radius);
    plumb_world_destroy(w);
}

static void drops_merge(void **state)
{
    (void)state;
    const double radius = 0.5;
    plumb_world *w = make_space(0.05, 300);
    assert_int_equal(plumb_liquid_set(w, &(plumb_liquid_desc){ .tension = 300, .viscosity = 20 }),
                     PLUMB_OK);
    add_drop(w, -0.52, 0, radius, 2, 0);
    add_drop(w, 0.48, 0, radius, 2, 0);
    sim_run(w, 60 * 60, HZ60);
    const double one = radius * sqrt(2.0);
    const look a = look_at(w, 2, one);
    print_message("two drops that touched are one of %.3f radii, mode 2 %.3f, rms %.3f of the "
                  "waves' speed\n",
                  a.farthest / one, a.mode, a.inner / wave_speed(300, one));
    assert_near(a.farthest, one, 0.1 * one);
    assert_true(a.inner < 0.05 * wave_speed(300, one));
    plumb_world_destroy(w);
}

// Without tension, and with one that is 0, the bits are the same.
static void no_tension_changes_no_bit(void **state)
{
    (void)state;
    plumb_world *w[2];
    for (int i = 0; i < 2; ++i) {
        w[i] = tank_make(3, 2, 0.05);
        tank_fill(w[i], 0, 0, 1, 1);
        const plumb_liquid_desc d = { .tension = 1 }, none = { .tension = 0 };
        assert_int_equal(plumb_liquid_set(w[i], i == 1 ? &d : &none), PLUMB_OK);
        assert_int_equal(plumb_liquid_set(w[i], &none), PLUMB_OK);
        sim_run(w[i], 60, HZ60);
    }
    const tank_state a = tank_look(w[0]), b = tank_look(w[1]);
    assert_true(a.mean_x == b.mean_x && a.rms == b.rms && a.front == b.front);
    assert_true(plumb_world_hash(w[0]) == plumb_world_hash(w[1]));
    plumb_world_destroy(w[0]);
    plumb_world_destroy(w[1]);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(drops_rest),
        cmocka_unit_test(pools_rest),
        cmocka_unit_test(drops_swing_as_rayleigh_says),
        cmocka_unit_test(pools_swing_by_tension_and_gravity),
        cmocka_unit_test(squares_become_drops),
        cmocka_unit_test(drops_merge),
        cmocka_unit_test(no_tension_changes_no_bit),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
