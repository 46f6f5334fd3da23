// test_liquid_motion.c - the liquid against closed forms and published data: a column at rest, volume after sloshing, a dam break
// (Martin & Moyce 1952), floating boxes, communicating vessels, turning vortices. What was measured stands in
// src/liquid/DECISIONS.md.
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "harness/near.h"
#include "harness/sim.h"

#define HZ60 (1 / 60.0)

static void add_wall(plumb_world *w, double x, double y, double hx, double hy)
{
    const plumb_material none = PLUMB_NULL_INIT;
    sim_add_box(w, sim_body(w, PLUMB_STATIC, x, y, 0), hx, hy, none);
}

// From (0, 0), open above.
static plumb_world *make_tank(double width, double height, double spacing)
{
    plumb_world *w = sim_world(&(plumb_world_desc){ 0 });
    add_wall(w, width / 2, -0.5, width / 2 + 1, 0.5);
    add_wall(w, -0.5, height / 2, 0.5, height / 2 + 1);
    add_wall(w, width + 0.5, height / 2, 0.5, height / 2 + 1);
    assert_int_equal(plumb_liquid_create(w, &(plumb_liquid_desc){ .spacing = (plumb_real)spacing }),
                     PLUMB_OK);
    return w;
}

static void add_water(plumb_world *w, double x0, double y0, double x1, double y1)
{
    assert_int_equal(plumb_liquid_add_box(w, sim_vec(x0, y0), sim_vec(x1, y1), NULL), PLUMB_OK);
}

typedef struct water {
    double mean_x, mean_y, rms, kinetic; // [m], [m/s], [m^2/s^2] a particle
    double front;                        // [m] the right-most
} water;

static water look(const plumb_world *w)
{
    int count;
    water a = { 0, 0, 0, 0, -INFINITY };
    const plumb_particle *p = plumb_liquid_particles(w, &count);
    for (int i = 0; i < count; ++i) {
        const double u = (double)p[i].velocity.x, v = (double)p[i].velocity.y;
        a.mean_x += (double)p[i].position.x / count;
        a.mean_y += (double)p[i].position.y / count;
        a.kinetic += (u * u + v * v) / 2 / count;
        a.front = fmax(a.front, (double)p[i].position.x);
    }
    a.rms = sqrt(2 * a.kinetic);
    return a;
}

//---- rest ----------------------------------------------------------------------------------------

static void a_column_rests_at_its_height(void **state)
{
    (void)state;
    plumb_world *w = make_tank(2, 4, 0.05);
    add_water(w, 0, 0, 2, 3);
    sim_run(w, 600, HZ60);
    const water a = look(w);
    print_message("column of 3 m after 10 s: height off by %.2g, rms speed %.2g m/s\n",
                  a.mean_y / 1.5 - 1, a.rms);
    assert_near(a.mean_y, 1.5, 1.5e-3);
    assert_true(a.rms < 1e-3);
    plumb_world_destroy(w);
}

// Columns of five widths break in tanks of 4 m and slosh for a minute: twice the mean height over that of the level
// water. What is left of the sloshing is in it, and a moment of one tank is chaotic: 0.998 to 1.029.
static void sloshing_keeps_the_volume(void **state)
{
    (void)state;
    double sum = 0;
    for (int i = 0; i < 5; ++i) {
        const double width = 1 + 0.05 * i;
        plumb_world *w = make_tank(4, 20, 0.05);
        add_water(w, 0, 0, width, 2);
        sim_run(w, 3600, HZ60);
        const water a = look(w);
        const double ratio = 2 * a.mean_y / (width / 2);
        print_message(
            "%.2f m broke, then 60 s: height over that of the volume %.4f, rms speed %.3f m/s\n",
            width, ratio, a.rms);
        assert_near(ratio, 1, 0.04);
        sum += ratio;
        plumb_world_destroy(w);
    }
    assert_near(sum / 5, 1, 0.015);
}

//---- motion --------------------------------------------------------------------------------------

// A column of a x 2 a; T = t sqrt(2 g / a). Frictionless codes lead the experiment by some 10 to 15 %: it has a bed
// and a gate.
static void a_dam_break_runs_as_measured(void **state)
{
    (void)state;
    static const double published[][2] = { { 0.85, 1.23 }, { 1.20, 1.46 }, { 1.60, 1.88 },
                                           { 2.30, 2.69 }, { 2.95, 3.65 }, { 3.60, 4.48 } };
    plumb_world *w = make_tank(8, 4, 0.04);
    add_water(w, 0, 0, 1, 2);
    double t = 0, last = 1;
    for (int i = 0; i < 6; ++i) {
        while (t * sqrt(2 * SIM_G) < published[i][0] - 1e-9) {
            sim_step(w, 1 / 240.0);
            t += 1 / 240.0;
        }
        const double front = look(w).front, lead = front / published[i][1] - 1;
        print_message("dam break, T = %.2f: front %.3f, measured %.2f (%+.0f %%)\n",
                      t * sqrt(2 * SIM_G), front, published[i][1], 100 * lead);
        assert_true(front > last && lead > -0.05 && lead < 0.30);
        last = front;
    }
    plumb_world_destroy(w);
}

// Two legs of a U, of equal width: the thread of length L swings at 2 g / L.
static void vessels_swing_and_level(void **state)
{
    (void)state;
    const double half = 0.2; // [m] half a leg's width
    plumb_world *w = make_tank(2, 4, 0.05);
    add_wall(w, 1, 2 + 2 * half, 1 - 2 * half, 2); // between the legs, from 2 half above the floor
    add_water(w, 0, 0, 2, 0.4);
    add_water(w, 0, 0.4, 0.4, 2.1);
    add_water(w, 1.6, 0.4, 2, 1.5);
    double before = -1, crossed[3] = { 0 };
    int crossings = 0;
    for (int i = 1; i <= 600 && crossings < 3; ++i) {
        sim_step(w, HZ60);
        const double off = look(w).mean_x - 1; // even legs: 0
        if (off * before < 0) {
            crossed[crossings++] = (i - off / (off - before)) * HZ60;
        }
        before = off;
    }
    assert_int_equal(crossings, 3);
    // The middle line of the thread: down one leg to the middle of the duct, along it, and up.
    const double length = 2 * (1.8 - 0.2) + 1.6, period = 2 * SIM_PI / sqrt(2 * SIM_G / length);
    const double measured = crossed[2] - crossed[0];
    print_message("U-tube: period %.3f s, thread of %.2f m %.3f s (%+.1f %%)\n", measured, length,
                  period, 100 * (measured / period - 1));
    assert_near(measured / period, 1, 0.08);
    plumb_world_destroy(w);
}

// Vortices between slipping walls, without gravity: u = sin x cos y decays as e^(-2 nu k^2 t), and not at all
// without viscosity.
static double vortex_energy(double viscosity, double seconds)
{
    plumb_world *w = sim_space();
    const double side = 2, k = SIM_PI / side;
    add_wall(w, side / 2, -0.5, side / 2 + 1, 0.5);
    add_wall(w, side / 2, side + 0.5, side / 2 + 1, 0.5);
    add_wall(w, -0.5, side / 2, 0.5, side / 2 + 1);
    add_wall(w, side + 0.5, side / 2, 0.5, side / 2 + 1);
    plumb_liquid_create(w, &(plumb_liquid_desc){ .spacing = (plumb_real)(1 / 32.0),
                                                 .viscosity = (plumb_real)viscosity });
    for (int j = 0; j < 64; ++j) {
        for (int i = 0; i < 64; ++i) {
            const double x = (i + 0.5) / 32, y = (j + 0.5) / 32;
            const double sx = sin(k * x), cx = cos(k * x), sy = sin(k * y), cy = cos(k * y);
            const plumb_particle p = {
                .position = sim_vec(x, y),
                .velocity = sim_vec(sx * cy, -cx * sy),
                .gradient = { (plumb_real)(k * cx * cy), (plumb_real)(-k * sx * sy),
                              (plumb_real)(k * sx * sy), (plumb_real)(-k * cx * cy) },
            };
            plumb_liquid_add(w, &p, 1);
        }
    }
    const double start = look(w).kinetic;
    sim_run(w, (int)lround(seconds * 60), HZ60);
    const double kept = look(w).kinetic / start;
    plumb_world_destroy(w);
    return kept;
}

static void vortices_keep_their_energy(void **state)
{
    (void)state;
    const double kept = vortex_energy(0, 2);
    print_message("Taylor-Green without viscosity: %.4f of the energy after 2 s\n", kept);
    assert_true(kept > 0.9 && kept < 1.01);
}

//---- bodies --------------------------------------------------------------------------------------

// A box that does not turn floats as deep as its density says.
static double draft_of(double ratio, double *rest)
{
    const double side = 1.5, level = 1.5;
    plumb_world *w = make_tank(7.5, 6, 0.0625);
    const plumb_material m =
        plumb_material_create(w, &(plumb_material_desc){ .density = (plumb_real)(1000 * ratio) });
    const plumb_body box = sim_body(w, PLUMB_DYNAMIC, 3.75, level - 0.5 * side + 0.75, 0);
    sim_add_box(w, box, side / 2, side / 2, m);
    plumb_body_set_fixed_rotation(w, box, true);
    plumb_body_teleport(w, box, sim_vec(3.75, level + side * (0.5 - ratio)), 0);
    add_water(w, 0, 0, 7.5, level);
    plumb_liquid_remove(w, sim_vec(3, level - side * ratio), sim_vec(4.5, 4));
    int count;
    plumb_liquid_particles(w, &count);
    sim_run(w, 1200, HZ60);
    // Water and what is displaced fill the tank up to the level.
    const double bottom = sim_y(w, box) - side / 2, area = count * 0.0625 * 0.0625;
    const double surface = (area - side * fmax(bottom, 0)) / (7.5 - side);
    *rest = hypot(sim_vx(w, box), sim_vy(w, box));
    const double lies = (area / 7.5 < bottom ? area / 7.5 : surface) - bottom;
    plumb_world_destroy(w);
    return lies / side;
}

static void boxes_float_by_their_density(void **state)
{
    (void)state;
    const double ratios[] = { 0.9, 0.5, 0.1, 0.01, 0.001 };
    for (int i = 0; i < 5; ++i) {
        double speed;
        const double draft = draft_of(ratios[i], &speed);
        print_message("box of %.3f of the density: draft %.3f of its side, %.3f m/s\n", ratios[i],
                      draft, speed);
        assert_near(draft, ratios[i], 0.06);
        assert_true(speed < (ratios[i] < 0.005 ? 1 : 0.4)); // the lightest goes on bobbing
    }
}

// Crates that fall into a pool enclose water between them that has no way out. Its sums once spoilt those of all water, which was
// pressed to a seventh of its height in five seconds.
static void crates_press_no_water_away(void **state)
{
    (void)state;
    plumb_world *w = make_tank(6, 9, 0.05);
    add_water(w, 0, 0, 6, 1.5);
    for (int i = 0; i < 60; ++i) {
        const plumb_shape_desc d = { .kind = PLUMB_BOX,
                                     .half = sim_vec(0.15, 0.15),
                                     .density = 500 };
        const plumb_body b =
            sim_body(w, PLUMB_DYNAMIC, 0.3 + 0.45 * (i % 12), 1.8 + 0.45 * (i / 12), 0);
        assert_false(plumb_is_null(plumb_shape_create(w, b, &d)));
    }
    double least = INFINITY;
    for (int second = 0; second < 10; ++second) {
        sim_run(w, 60, HZ60);
        least = fmin(least, look(w).mean_y);
    }
    print_message("60 crates in 1.5 m of water, 10 s: mean height of the water at least %.3f m\n",
                  least);
    assert_true(least > 0.75);
    plumb_world_destroy(w);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_column_rests_at_its_height),
        cmocka_unit_test(sloshing_keeps_the_volume),
        cmocka_unit_test(a_dam_break_runs_as_measured),
        cmocka_unit_test(vessels_swing_and_level),
        cmocka_unit_test(vortices_keep_their_energy),
        cmocka_unit_test(boxes_float_by_their_density),
        cmocka_unit_test(crates_press_no_water_away),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
