// test_liquid_motion.c - the liquid against closed forms and published data: a column at rest, volume after sloshing, a dam break
// (Martin & Moyce 1952), communicating vessels, a hole in the floor, turning vortices. What was measured stands in
// src/liquid/DECISIONS.md.
// PLUMB_LONG
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "harness/near.h"
#include "harness/sim.h"
#include "harness/tank.h"

#define HZ60 (1 / 60.0)

//---- rest ----------------------------------------------------------------------------------------

static void a_column_rests_at_its_height(void **state)
{
    (void)state;
    plumb_world *w = tank_make(2, 4, 0.05);
    tank_fill(w, 0, 0, 2, 3);
    sim_run(w, 600, HZ60);
    const tank_state a = tank_look(w);
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
        plumb_world *w = tank_make(4, 20, 0.05);
        tank_fill(w, 0, 0, width, 2);
        sim_run(w, 3600, HZ60);
        const tank_state a = tank_look(w);
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
    plumb_world *w = tank_make(8, 4, 0.04);
    tank_fill(w, 0, 0, 1, 2);
    double t = 0, last = 1;
    for (int i = 0; i < 6; ++i) {
        while (t * sqrt(2 * SIM_G) < published[i][0] - 1e-9) {
            sim_step(w, 1 / 240.0);
            t += 1 / 240.0;
        }
        const double front = tank_look(w).front, lead = front / published[i][1] - 1;
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
    plumb_world *w = tank_make(2, 4, 0.05);
    tank_wall(w, 1, 2 + 2 * half, 1 - 2 * half, 2); // between the legs, from 2 half above the floor
    tank_fill(w, 0, 0, 2, 0.4);
    tank_fill(w, 0, 0.4, 0.4, 2.1);
    tank_fill(w, 1.6, 0.4, 2, 1.5);
    double before = -1, crossed[3] = { 0 };
    int crossings = 0;
    for (int i = 1; i <= 600 && crossings < 3; ++i) {
        sim_step(w, HZ60);
        const double off = tank_look(w).mean_x - 1; // even legs: 0
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

// A hundred pebbles lie behind the wall of a narrow tank, in the tiles of its water but out of its reach: not a bit of what splashes in
// it changes.
static void what_is_out_of_reach_changes_nothing(void **state)
{
    (void)state;
    plumb_particle *kept = NULL;
    for (int k = 0; k < 2; ++k) {
        plumb_world *w = sim_world(&(plumb_world_desc){ 0 });
        for (int i = 0; i < 100 * k; ++i) { // made before what holds the water
            tank_wall(w, 0.98 + 0.025 * (i % 10), 0.1 + 0.1 * (i / 10), 0.01, 0.01);
        }
        tank_wall(w, 0.3, -0.47, 1.3,
                  0.5); // off the lines of the grid: else faces alone hold the water
        tank_wall(w, -0.46, 3, 0.5, 4);
        tank_wall(w, 0.74, 3, 0.1, 4);
        assert_int_equal(plumb_liquid_create(w, NULL), PLUMB_OK);
        tank_fill(w, 0.04, 0.03, 0.64, 0.33);
        tank_fill(w, 0.1, 0.8, 0.4, 1.2);
        sim_run(w, 120, HZ60);
        int n;
        const plumb_particle *p = plumb_liquid_particles(w, &n);
        assert_int_equal(n, 120);
        if (k == 0) {
            kept = malloc((size_t)n * sizeof *kept);
            assert_non_null(kept);
            memcpy(kept, p, (size_t)n * sizeof *kept);
        } else {
            assert_memory_equal(kept, p, (size_t)n * sizeof *kept);
        }
        plumb_world_destroy(w);
    }
    free(kept);
}

// Through a hole of 0.5 m in the floor of a tank of 4 m, 2 m deep: by Torricelli, what runs out has the head of the surface; by Kirchhoff (1869)
// a thin edge draws the jet in to pi / (pi + 2) of the hole. The floor is 0.1 m thick.
typedef struct outflow {
    double head;  // of a particle under the hole, from its floor, over the depth
    double share; // what runs out over the hole's width times sqrt(2 g depth)
} outflow;

static double water_above_floor(const plumb_world *w, double spacing)
{
    int n, above = 0;
    const plumb_particle *p = plumb_liquid_particles(w, &n);
    for (int i = 0; i < n; ++i) {
        above += (double)p[i].position.y > 0;
    }
    return above * spacing * spacing;
}

static double mean_head(const plumb_world *w, double from, double to)
{
    int n, count = 0;
    double sum = 0;
    const plumb_particle *p = plumb_liquid_particles(w, &n);
    for (int i = 0; i < n; ++i) {
        const double y = (double)p[i].position.y;
        if (y > from && y < to) {
            const double vx = (double)p[i].velocity.x, vy = (double)p[i].velocity.y;
            sum += y + (vx * vx + vy * vy) / (2 * SIM_G);
            ++count;
        }
    }
    return sum / count;
}

static outflow run_out(double spacing)
{
    const double width = 4, hole = 0.5;
    plumb_world *w = sim_world(&(plumb_world_desc){ 0 });
    tank_wall(w, (width - hole) / 4 - 0.5, -0.05, (width - hole) / 4 + 0.5, 0.05);
    tank_wall(w, width - (width - hole) / 4 + 0.5, -0.05, (width - hole) / 4 + 0.5, 0.05);
    tank_wall(w, -0.5, 2, 0.5, 2);
    tank_wall(w, width + 0.5, 2, 0.5, 2);
    plumb_liquid_create(w, &(plumb_liquid_desc){ .spacing = (plumb_real)spacing });
    tank_fill(w, 0, 0, width, 2);
    sim_run(w, 60, HZ60); // until it flows evenly
    const double before = water_above_floor(w, spacing);
    sim_run(w, 30, HZ60);
    const double after = water_above_floor(w, spacing), depth = (before + after) / (2 * width);
    const outflow out = { mean_head(w, -1.5, -0.6) / (after / width),
                          (before - after) / (0.5 * hole * sqrt(2 * SIM_G * depth)) };
    print_message(
        "a hole of %.0f cells: head of the jet over the depth %.3f, width over the hole's %.3f\n",
        hole / (2 * spacing), out.head, out.share);
    plumb_world_destroy(w);
    return out;
}

static void water_runs_out_as_fast_as_it_would_fall(void **state)
{
    (void)state;
    const outflow coarse = run_out(0.025), fine = run_out(0.0125);
    const double edge = SIM_PI / (SIM_PI + 2);
    assert_true(fine.head > 0.95 && fine.head < 1.005);
    assert_true(1 - fine.head < 0.5 * (1 - coarse.head)); // of first order at least
    assert_true(fine.share > edge - 0.02 && fine.share - edge < 0.55 * (coarse.share - edge));
}

// Vortices between slipping walls, without gravity: u = sin x cos y decays as e^(-2 nu k^2 t), and not at all
// without viscosity.
static double vortex_energy(double viscosity, double seconds)
{
    plumb_world *w = sim_space();
    const double side = 2, k = SIM_PI / side;
    tank_wall(w, side / 2, -0.5, side / 2 + 1, 0.5);
    tank_wall(w, side / 2, side + 0.5, side / 2 + 1, 0.5);
    tank_wall(w, -0.5, side / 2, 0.5, side / 2 + 1);
    tank_wall(w, side + 0.5, side / 2, 0.5, side / 2 + 1);
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
    const double start = tank_look(w).kinetic;
    sim_run(w, (int)lround(seconds * 60), HZ60);
    const double kept = tank_look(w).kinetic / start;
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

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_column_rests_at_its_height),
        cmocka_unit_test(sloshing_keeps_the_volume),
        cmocka_unit_test(a_dam_break_runs_as_measured),
        cmocka_unit_test(vessels_swing_and_level),
        cmocka_unit_test(what_is_out_of_reach_changes_nothing),
        cmocka_unit_test(water_runs_out_as_fast_as_it_would_fall),
        cmocka_unit_test(vortices_keep_their_energy),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
