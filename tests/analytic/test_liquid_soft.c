// test_liquid_soft.c - soft bodies in the liquid that flows: how deep they float, what water presses them together by, and that no
// lightness, stiffness, press or start under water throws them. What was measured stands in src/liquid/DECISIONS.md.
// PLUMB_LONG
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>

#include <cmocka.h>

#include "harness/near.h"
#include "harness/random.h"
#include "harness/sim.h"
#include "harness/tank.h"
#include "harness/trials.h"

#define HZ60   (1 / 60.0)
#define THROWN 12 // [m/s]

static plumb_softbody add_jelly(plumb_world *w, double x, double y, double side, double density,
                                double young)
{
    const double h = side / 2;
    const plumb_vec2 points[4] = { sim_vec(x - h, y - h), sim_vec(x + h, y - h),
                                   sim_vec(x + h, y + h), sim_vec(x - h, y + h) };
    const plumb_softbody s =
        plumb_jelly_create(w, &(plumb_jelly_desc){ .points = points,
                                                   .count = 4,
                                                   .spacing = (plumb_real)(side / 6),
                                                   .density = (plumb_real)density,
                                                   .young = (plumb_real)young });
    assert_false(plumb_is_null(s));
    return s;
}

static plumb_softbody add_skin(plumb_world *w, double x, double y, double mass, double pressure)
{
    const plumb_softbody s =
        plumb_skin_create(w, &(plumb_skin_desc){ .center = sim_vec(x, y),
                                                 .radius = (plumb_real)0.5,
                                                 .mass = (plumb_real)mass,
                                                 .pressure = (plumb_real)pressure,
                                                 .stiffness = (plumb_real)(20 * pressure) });
    assert_false(plumb_is_null(s));
    return s;
}

static plumb_softbody_state look(const plumb_world *w, plumb_softbody s)
{
    plumb_softbody_state m;
    assert_int_equal(plumb_softbody_measure(w, s, &m), PLUMB_OK);
    return m;
}

// [m/s] of its nodes, rms.
static double speed_of(const plumb_world *w, plumb_softbody s)
{
    const plumb_softbody_state m = look(w, s);
    return sqrt(2 * (double)m.kinetic / (double)m.mass);
}

// Mean height over the last of so many seconds; the largest speed in all.
static double mean_height(plumb_world *w, plumb_softbody s, int seconds, int last, double *fastest)
{
    double sum = 0;
    *fastest = 0;
    for (int k = 0; k < 60 * seconds; ++k) {
        sim_step(w, HZ60);
        *fastest = fmax(*fastest, speed_of(w, s));
        sum += k >= 60 * (seconds - last) ? (double)look(w, s).center.y / (60 * last) : 0;
    }
    return sum;
}

//---- what floats ---------------------------------------------------------------------------------

// A square floats with half of its height above its draft, whichever way it lies: below a density of 0.21 flat, and at one half on its
// edge, by symmetry with its middle at the surface.
static void jelly_floats_by_its_density(void **state)
{
    (void)state;
    const double ratios[] = { 0.9, 0.5, 0.1, 0.01, 0.001 }, side = 1.2;
    for (size_t i = 0; i < sizeof ratios / sizeof ratios[0]; ++i) {
        for (int stiff = 0; stiff < 2; ++stiff) {
            if (!trials_takes(2 * (uint32_t)i + (uint32_t)stiff, 3)) {
                continue;
            }
            const double young = stiff ? 1e8 : 1e6;
            plumb_world *w = tank_make(4, 6, 0.05);
            tank_fill(w, 0, 0, 4, 2);
            const double level = 2 + side * side * ratios[i] / 4;
            const plumb_softbody s =
                add_jelly(w, 2.01, 2.05 + side / 2, side, 1000 * ratios[i], young);
            double fastest;
            const double y = mean_height(w, s, 16, 8, &fastest);
            assert_near(y, level + side * (0.5 - ratios[i]), 0.03);
            assert_true(fastest < 3);
            plumb_world_destroy(w);
        }
    }
}

// What stands above the surface of a skin that weighs so much: the circle's segment below displaces its weight.
static void skins_float_by_their_mass(void **state)
{
    (void)state;
    for (double mass = 1; mass < 500; mass *= 7) {
        plumb_world *w = tank_make(4, 6, 0.05);
        tank_fill(w, 0, 0, 4, 2);
        const plumb_softbody s = add_skin(w, 2.01, 2.55, mass, 1e5);
        double fastest;
        const double y = mean_height(w, s, 12, 6, &fastest), area = (double)look(w, s).area;
        const double radius = sqrt(area / 3.14159265358979), level = 2 + mass / 4000;
        double low = -radius, high = radius; // of the surface, over its middle
        for (int k = 0; k < 60; ++k) {
            const double d = (low + high) / 2;
            const double below =
                radius * radius * acos(-d / radius) + d * sqrt(radius * radius - d * d);
            *(below * 1000 < mass ? &low : &high) = d;
        }
        assert_near(level - low, y, 0.04);
        assert_true(fastest < 2.5);
        plumb_world_destroy(w);
    }
}

// Water all round presses a sheet of plane stress together by 2 (1 - nu) p / E of its area, its own weight but for lift by half of that
// for its mean.
static void water_presses_what_lies_deep_together(void **state)
{
    (void)state;
    const double side = 0.8, density = 1500, young = 4e5, nu = 0.4;
    plumb_world *w = tank_make(3, 6, 0.05);
    const plumb_softbody s = add_jelly(w, 1.51, side / 2 + 0.08, side, density, young);
    tank_fill(w, 0, 0, 3, 3);
    plumb_liquid_remove(w, sim_vec(1.05, -1), sim_vec(1.97, 0.96));
    sim_run(w, 600, HZ60);
    plumb_softbody_desc d;
    assert_int_equal(plumb_softbody_settings(w, s, &d), PLUMB_OK);
    double area = 0;
    for (int i = 0; i < d.triangle_count; ++i) {
        const plumb_softbody_triangle *t = &d.triangles[i];
        const plumb_vec2 a = d.nodes[t->a].position, b = d.nodes[t->b].position,
                         c = d.nodes[t->c].position;
        area += ((double)(b.x - a.x) * (double)(c.y - a.y) -
                 (double)(b.y - a.y) * (double)(c.x - a.x)) /
                2;
    }
    int count;
    plumb_liquid_particles(w, &count);
    const double surface = (count * 0.05 * 0.05 + area) / 3;
    const double pressure = 1000 * 9.81 * (surface - (double)look(w, s).center.y);
    const double own = (density - 1000) * 9.81 * side / 2;
    const double expected = (2 * pressure + own) * (1 - nu) / young;
    assert_near(1 - area / (side * side) - expected, 0, 0.1 * expected);
    plumb_world_destroy(w);
}

//---- what throws nothing -------------------------------------------------------------------------

// A plate presses it under and lets it go; or it begins under water, in which it takes room. The pressure of the deep
// water would drive it at sqrt(2 g h) = 6 m/s; nodes of light ones shake besides: 8.6 m/s at most was measured, in all precisions.
static double fastest_under_a_plate(plumb_softbody (*add)(plumb_world *, uint32_t *), uint32_t seed)
{
    uint32_t r = seed;
    plumb_world *w = tank_make(4, 6, 0.05 + 0.03 * sim_uniform(&r, 0, 1));
    tank_fill(w, 0, 0, 4, 2);
    const plumb_body plate = sim_body(w, PLUMB_KINEMATIC, 2, 3.9, 0);
    const plumb_material none = PLUMB_NULL_INIT;
    sim_add_box(w, plate, 0.6, 0.1, none);
    const plumb_softbody s = add(w, &r);
    double fastest = 0;
    for (int k = 0; k < 420; ++k) {
        const double v = k < 200 ? -0.6 : k < 300 ? 1.2 : 0;
        assert_int_equal(plumb_body_set_velocity(w, plate, sim_vec(0, v)), PLUMB_OK);
        sim_step(w, HZ60);
        fastest = fmax(fastest, speed_of(w, s));
    }
    plumb_world_destroy(w);
    return fastest;
}

static double spread(uint32_t *r, double low, double high)
{
    return low * pow(high / low, sim_uniform(r, 0, 1));
}

static plumb_softbody any_jelly(plumb_world *w, uint32_t *r)
{
    const double density = spread(r, 0.1, 2000), young = spread(r, 5e4, 1e9);
    return add_jelly(w, 2 + 0.3 * (sim_uniform(r, 0, 1) - 0.5), 0.7 + 2 * sim_uniform(r, 0, 1), 1,
                     density, young);
}

static plumb_softbody any_skin(plumb_world *w, uint32_t *r)
{
    const double mass = spread(r, 0.1, 500), pressure = spread(r, 2e4, 1e6);
    return add_skin(w, 2 + 0.3 * (sim_uniform(r, 0, 1) - 0.5), 0.7 + 2 * sim_uniform(r, 0, 1), mass,
                    pressure);
}

static void nothing_soft_is_thrown(void **state)
{
    (void)state;
    for (uint32_t seed = 1; seed <= 12; ++seed) {
        if (!trials_takes(seed, 4)) {
            continue;
        }
        const double jelly = fastest_under_a_plate(any_jelly, seed);
        const double skin = fastest_under_a_plate(any_skin, seed);
        if (!(jelly < THROWN) || !(skin < THROWN)) {
            print_message("seed %d: jelly %g, skin %g m/s\n", (int)seed, jelly, skin);
        }
        assert_true(jelly < THROWN);
        assert_true(skin < THROWN);
    }
}

// Threads let the liquid through: a pool with a net in it is the pool without.
static void threads_let_it_through(void **state)
{
    (void)state;
    double rms[2];
    for (int with = 0; with < 2; ++with) {
        plumb_world *w = tank_make(3, 4, 0.05);
        tank_fill(w, 0, 0, 1.5, 2);
        if (with == 1) {
            const plumb_softbody net = plumb_cloth_create(
                w, &(plumb_cloth_desc){
                       .low = { 1, (plumb_real)0.2 }, .high = { 2, 1 }, .hold_corners = true });
            assert_false(plumb_is_null(net));
        }
        sim_run(w, 60, HZ60);
        rms[with] = tank_look(w).rms;
        plumb_world_destroy(w);
    }
    assert_true(rms[0] > 0.1 && rms[0] == rms[1]);
}

//---- state ---------------------------------------------------------------------------------------

// What held it is state: an image goes on as the world does.
static void an_image_goes_on_alike(void **state)
{
    (void)state;
    plumb_world *w = tank_make(4, 6, 0.08);
    tank_fill(w, 0, 0, 4, 2);
    add_jelly(w, 1, 3, 0.8, 300, 1e5);
    add_skin(w, 2.6, 2.6, 20, 3e4);
    sim_run(w, 40, HZ60);
    const size_t size = plumb_world_snapshot_size(w);
    void *image = malloc(size);
    assert_int_equal(plumb_world_save(w, image, size), PLUMB_OK);
    sim_run(w, 60, HZ60);
    const uint64_t hash = plumb_world_hash(w);
    assert_int_equal(plumb_world_restore(w, image, size), PLUMB_OK);
    sim_run(w, 60, HZ60);
    assert_true(plumb_world_hash(w) == hash);
    free(image);
    plumb_world_destroy(w);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(jelly_floats_by_its_density),
        cmocka_unit_test(skins_float_by_their_mass),
        cmocka_unit_test(water_presses_what_lies_deep_together),
        cmocka_unit_test(nothing_soft_is_thrown),
        cmocka_unit_test(threads_let_it_through),
        cmocka_unit_test(an_image_goes_on_alike),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
