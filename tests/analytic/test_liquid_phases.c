// test_liquid_phases.c - liquids of several phases: layers at rest, what floats between them, waves between them, what
// was stirred parts again, momentum, and that a phase like the first, or one far off, changes no bit.
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "harness/near.h"
#include "harness/random.h"
#include "harness/sim.h"
#include "harness/tank.h"
#include "harness/trials.h"

#define HZ60 (1 / 60.0)
#define PI   3.14159265358979323846

// From (0, 0), open above. The first phase is water; the second has a density, and a viscosity.
static plumb_world *make_tank(double width, double height, double spacing, double density,
                              double viscosity)
{
    plumb_world *w = tank_make(width, height, spacing);
    const plumb_liquid_phase second = { .density = (plumb_real)density,
                                        .viscosity = (plumb_real)viscosity };
    assert_int_equal(plumb_liquid_set_phases(w, &second, 1), PLUMB_OK);
    return w;
}

static void fill(plumb_world *w, uint32_t phase, double x0, double y0, double x1, double y1)
{
    assert_int_equal(plumb_liquid_add_box(w, sim_vec(x0, y0), sim_vec(x1, y1),
                                          &(plumb_particle){ .phase = phase }),
                     PLUMB_OK);
}

typedef struct layer {
    int count;
    double y, rms; // mean height [m], [m/s]
} layer;

static layer look(const plumb_world *w, uint32_t phase)
{
    int count;
    layer a = { 0, 0, 0 };
    const plumb_particle *p = plumb_liquid_particles(w, &count);
    for (int i = 0; i < count; ++i) {
        if (p[i].phase == phase) {
            const double u = (double)p[i].velocity.x, v = (double)p[i].velocity.y;
            a.y += (double)p[i].position.y;
            a.rms += u * u + v * v;
            ++a.count;
        }
    }
    a.y /= a.count;
    a.rms = sqrt(a.rms / a.count);
    return a;
}

//---- layers --------------------------------------------------------------------------------------

static void layers_rest(void **state)
{
    (void)state;
    for (int i = 0; i < 3; ++i) {
        const double densities[] = { 800, 10, 999 }, viscosities[] = { 0, 0, 50 };
        plumb_world *w = make_tank(2, 3, 0.05, densities[i], viscosities[i]);
        fill(w, 0, 0, 0, 2, 1);
        fill(w, 1, 0, 1, 2, 1.6);
        sim_run(w, 300, HZ60);
        const layer water = look(w, 0), oil = look(w, 1);
        print_message("%g on 1000 kg/m^2 after 5 s: heights off by %.2g and %.2g m, rms %.2g m/s\n",
                      densities[i], water.y - 0.5, oil.y - 1.3, oil.rms);
        assert_near(water.y, 0.5, 1e-3);
        assert_near(oil.y, 1.3, 2e-3);
        assert_true(water.rms < 1e-3 && oil.rms < 1e-3);
        plumb_world_destroy(w);
    }
}

// A box as dense as the mean of both lies half in each: Archimedes.
static void what_is_between_floats_between(void **state)
{
    (void)state;
    const double share[] = { 0.25, 0.5, 0.75 };
    for (int i = 0; i < 3; ++i) {
        if (!trials_takes((uint32_t)i, 3)) {
            continue;
        }
        plumb_world *w = make_tank(4, 4, 0.05, 600, 0);
        fill(w, 0, 0, 0, 4, 1.5);
        fill(w, 1, 0, 1.5, 4, 3);
        const double density = 600 + 400 * share[i];
        const plumb_body box = sim_body(w, PLUMB_DYNAMIC, 2, 1.6, 0);
        const plumb_shape_desc d = { .half = { PLUMB_REAL(0.5), PLUMB_REAL(0.5) },
                                     .kind = PLUMB_BOX,
                                     .density = (plumb_real)density };
        assert_false(plumb_is_null(plumb_shape_create(w, box, &d)));
        plumb_liquid_remove(w, sim_vec(1.5, 1.1), sim_vec(2.5, 2.1));
        sim_run(w, 1200, HZ60);
        double mean = 0;
        for (int k = 0; k < 300; ++k) {
            sim_run(w, 1, HZ60);
            mean += (double)plumb_body_center(w, box).y / 300;
        }
        const layer water = look(w, 0);
        // Where the border would be if it were level: what the box takes away lifts it.
        const double border = (water.count * 0.05 * 0.05 + share[i]) / 4;
        const double immersed = border - (mean - 0.5);
        print_message(
            "%g kg/m^2 between 600 and 1000: %.3f of it in the lower (Archimedes: %.3f)\n", density,
            immersed, share[i]);
        assert_near(immersed, share[i], 0.06);
        plumb_world_destroy(w);
    }
}

//---- waves ---------------------------------------------------------------------------------------

// The period of the lowest wave between two layers, each 0.5 m high, in a closed box 2 m wide, set going by the velocities
// of linear theory: over two of them, as single crossings are off by up to 7 % either way.
static double period_of(double spacing, double density)
{
    enum { HZ = 120, CROSSINGS = 4 };
    const double width = 2, h = 0.5, k = PI / width, speed = 0.05;
    plumb_world *w = make_tank(width, 1, spacing, density, 0);
    tank_wall(w, 1, 1.5, 3, 0.5);
    const int columns = (int)(width / spacing + 0.5), rows = (int)(2 * h / spacing + 0.5);
    for (int j = 0; j < rows; ++j) {
        for (int i = 0; i < columns; ++i) {
            const double x = (i + 0.5) * spacing, y = (j + 0.5) * spacing - h;
            const double deep = y < 0 ? y + h : h - y, s = speed / sinh(k * h);
            const double side = y < 0 ? -1 : 1;
            const plumb_particle p = { .position = sim_vec(x, y + h),
                                       .velocity = sim_vec(side * s * cosh(k * deep) * sin(k * x),
                                                           s * sinh(k * deep) * cos(k * x)),
                                       .phase = y > 0 };
            assert_int_equal(plumb_liquid_add(w, &p, 1), PLUMB_OK);
        }
    }
    double before = 0;
    for (int n = 1, crossings = 0;; ++n) {
        int count;
        double mode = 0;
        sim_run(w, 1, 1.0 / HZ);
        const plumb_particle *p = plumb_liquid_particles(w, &count);
        for (int i = 0; i < count; ++i) {
            const double at = (double)p[i].position.y * cos(k * (double)p[i].position.x);
            mode += p[i].phase == 0 ? at : -at;
        }
        assert_true(n < 60 * HZ);
        crossings += before != 0 && (before > 0) != (mode > 0);
        if (crossings == CROSSINGS) {
            plumb_world_destroy(w);
            return 2 * (n - mode / (mode - before)) / HZ / CROSSINGS;
        }
        before = mode;
    }
}

static void waves_between_layers_swing_as_predicted(void **state)
{
    (void)state;
    const double densities[] = { 800, 100 };
    for (int i = 0; i < 2; ++i) {
        const double k = PI / 2, g = 9.80665, coth = 1 / tanh(k * 0.5);
        const double omega = sqrt(g * k * (1000 - densities[i]) / ((1000 + densities[i]) * coth));
        const double ratio = period_of(0.025, densities[i]) * omega / (2 * PI);
        print_message("%g over 1000, 40 cells: period over that of linear theory %.4f\n",
                      densities[i], ratio);
        assert_near(ratio, 1, 0.04);
    }
}

//---- what was stirred ----------------------------------------------------------------------------

// Phases at random in every place: the lighter comes to lie above. One velocity a cell alone would leave them stirred.
static void what_was_stirred_parts(void **state)
{
    (void)state;
    const double viscosities[] = { 0, 5 };
    for (int i = 0; i < 2; ++i) {
        plumb_world *w = make_tank(1, 2, 0.05, 800, viscosities[i]);
        uint32_t r = 5;
        int oil = 0;
        for (int k = 0; k < 20 * 20; ++k) {
            const plumb_particle p = { .position = sim_vec(0.05 * (k % 20) + 0.025,
                                                           0.05 * (k / 20) + 0.025),
                                       .phase = sim_uniform(&r, 0, 1) < 0.5 };
            oil += p.phase == 1;
            assert_int_equal(plumb_liquid_add(w, &p, 1), PLUMB_OK);
        }
        const double depth = 1 - oil / 400.0;
        sim_run(w, 900, HZ60);
        const layer low = look(w, 0), high = look(w, 1);
        print_message("stirred, %g Pa s, 15 s: mean heights %.3f and %.3f m; parted they are %.3f "
                      "and %.3f\n",
                      viscosities[i], low.y, high.y, depth / 2, (1 + depth) / 2);
        assert_near(low.y, depth / 2, 0.05);
        assert_near(high.y, (1 + depth) / 2, 0.05);
        plumb_world_destroy(w);
    }
}

// One particle of the other phase: a drop, as wide as the spacing, at its terminal velocity.
static void drops_rise_and_sink(void **state)
{
    (void)state;
    const double densities[] = { 700, 1500 };
    for (int i = 0; i < 2; ++i) {
        const double s = 0.05, g = 9.80665, b = 18 * 0.5 / 1000 / (s * s), a = 0.75 / s;
        const double pull = fabs(densities[i] - 1000) / 1000 * g;
        const double terminal = 2 * pull / (b + sqrt(b * b + 4 * a * pull));
        plumb_world *w = make_tank(2, 3, s, densities[i], 0.5);
        plumb_liquid_set(w, &(plumb_liquid_desc){ .viscosity = PLUMB_REAL(0.5) });
        fill(w, 0, 0, 0, 2, 2);
        plumb_liquid_change_phase(w, sim_vec(0.99, 0.99), sim_vec(1.04, 1.04), 0, 1);
        assert_int_equal(look(w, 1).count, 1);
        const double from = look(w, 1).y;
        sim_run(w, 60, HZ60);
        const double speed = look(w, 1).y - from;
        print_message("a drop of %g kg/m^2: %.3f m/s; terminal velocity %.3f\n", densities[i],
                      speed, terminal);
        assert_true(speed * (1000 - densities[i]) > 0);
        assert_true(fabs(speed) > 0.7 * terminal && fabs(speed) < 1.2 * terminal);
        plumb_world_destroy(w);
    }
}

//---- sums ----------------------------------------------------------------------------------------

// A heavy drop meets a light one in space: what the one loses the other gets, but for what surfaces between cells take, half a
// hundredth of the momentum.
// A round bubble of a tenth of the water's density lets go: what it pushes aside weighs as much as it displaces, so it begins to rise by
// g (1 - r) / (1 + r). In a tank of ten radii, over the first tenth of a second: then it becomes a mushroom.
static double rise_of_bubble(double spacing)
{
    const double side = 4, radius = 0.4, ratio = 0.1, t = 0.1;
    plumb_world *w = make_tank(side, side, spacing, 1000 * ratio, 0);
    const int n = (int)lround(side / spacing);
    for (int k = 0; k < n * n; ++k) {
        const double x = (k % n + 0.5) * spacing, y = (k / n + 0.5) * spacing;
        const bool in = hypot(x - side / 2, y - side / 2) < radius;
        assert_int_equal(
            plumb_liquid_add(w, &(plumb_particle){ .position = sim_vec(x, y), .phase = in }, 1),
            PLUMB_OK);
    }
    const double before = look(w, 1).y;
    sim_run(w, (int)lround(240 * t), 1 / 240.0);
    const double rise = look(w, 1).y - before;
    const double over = rise / (SIM_G * (1 - ratio) / (1 + ratio) * t * t / 2);
    print_message("a bubble of %.0f cells: rise in its first tenth of a second over theory %.3f\n",
                  radius / spacing, over);
    plumb_world_destroy(w);
    return over;
}

static void a_bubble_begins_to_rise_with_its_added_mass(void **state)
{
    (void)state;
    const double coarse = rise_of_bubble(0.04), fine = rise_of_bubble(0.02);
    assert_near(fine, 1, 0.06);
    assert_true(fabs(fine - 1) < 0.5 * fabs(coarse - 1));
}

static void momentum_is_that_of_masses(void **state)
{
    (void)state;
    plumb_world *w = sim_space();
    plumb_liquid_create(w, &(plumb_liquid_desc){ .spacing = PLUMB_REAL(0.05) });
    plumb_liquid_set_phases(w, &(plumb_liquid_phase){ .density = 100 }, 1);
    plumb_liquid_add_box(w, sim_vec(-1, 0), sim_vec(0, 1),
                         &(plumb_particle){ .velocity = sim_vec(1, 0.2) });
    plumb_liquid_add_box(w, sim_vec(0.2, 0.2), sim_vec(1.2, 1.2),
                         &(plumb_particle){ .velocity = sim_vec(-1, 0), .phase = 1 });
    double sum[2][2] = { { 0 } };
    for (int moment = 0; moment < 2; ++moment) {
        int count;
        const plumb_particle *p = plumb_liquid_particles(w, &count);
        for (int i = 0; i < count; ++i) {
            const double mass = p[i].phase == 0 ? 2.5 : 0.25;
            sum[moment][0] += mass * (double)p[i].velocity.x;
            sum[moment][1] += mass * (double)p[i].velocity.y;
        }
        sim_run(w, moment == 0 ? 60 : 0, HZ60);
    }
    print_message("momentum before and after: %.4f, %.4f; %.4f, %.4f Ns\n", sum[0][0], sum[0][1],
                  sum[1][0], sum[1][1]);
    assert_near(sum[1][0], sum[0][0], 10);
    assert_near(sum[1][1], sum[0][1], 10);
    plumb_world_destroy(w);
}

//---- bits ----------------------------------------------------------------------------------------

// A dam breaks: as one phase, as two that are alike, and with a drop of another far off, which makes all of it go the way
// of mixtures.
static void like_phases_are_one(void **state)
{
    (void)state;
    plumb_particle *first = NULL;
    for (int kind = 0; kind < 3; ++kind) {
        plumb_world *w = make_tank(4, 4, 0.1, kind == 2 ? 700 : 1000, 0);
        int count;
        fill(w, 0, 0, 0, 1, 1);
        fill(w, kind == 1, 0, 1, 1, 2);
        if (kind == 2) {
            assert_int_equal(
                plumb_liquid_add(w, &(plumb_particle){ .position = { 300, 9 }, .phase = 1 }, 1),
                PLUMB_OK);
        }
        sim_run(w, 120, HZ60);
        const plumb_particle *p = plumb_liquid_particles(w, &count);
        if (first == NULL) {
            first = malloc((size_t)count * sizeof *first);
            assert_non_null(first);
            memcpy(first, p, (size_t)count * sizeof *first);
        }
        for (int i = 0; i < 200; ++i) {
            assert_memory_equal(&p[i].position, &first[i].position, sizeof p->position);
            assert_memory_equal(&p[i].velocity, &first[i].velocity, sizeof p->velocity);
        }
        plumb_world_destroy(w);
    }
    free(first);
}

// Pitch below, water above: the water runs off, the pitch stands.
static void each_phase_has_its_viscosity(void **state)
{
    (void)state;
    plumb_world *w = make_tank(6, 3, 0.05, 1200, 1e6);
    fill(w, 1, 0, 0, 1, 1);
    fill(w, 0, 0, 1, 1, 2);
    sim_run(w, 180, HZ60);
    int count, pitch = 0, water = 0, pitch_in = 0, water_out = 0;
    const plumb_particle *p = plumb_liquid_particles(w, &count);
    for (int i = 0; i < count; ++i) {
        const double x = (double)p[i].position.x;
        pitch += p[i].phase == 1;
        pitch_in += p[i].phase == 1 && x < 1.1;
        water += p[i].phase == 0;
        water_out += p[i].phase == 0 && x > 1.1;
    }
    print_message("after 3 s %d of %d particles of pitch stand, %d of %d of water have run off\n",
                  pitch_in, pitch, water_out, water);
    assert_true(pitch_in > 0.93 * pitch && water_out > 0.7 * water);
    plumb_world_destroy(w);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(layers_rest),
        cmocka_unit_test(what_is_between_floats_between),
        cmocka_unit_test(waves_between_layers_swing_as_predicted),
        cmocka_unit_test(what_was_stirred_parts),
        cmocka_unit_test(drops_rise_and_sink),
        cmocka_unit_test(a_bubble_begins_to_rise_with_its_added_mass),
        cmocka_unit_test(momentum_is_that_of_masses),
        cmocka_unit_test(like_phases_are_one),
        cmocka_unit_test(each_phase_has_its_viscosity),
    };
    return cmocka_run_group_tests_name("phases of the liquid", tests, NULL, NULL);
}
