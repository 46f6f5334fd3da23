// test_liquid_grains.c - granular phases against theory: layers on a slope, columns that collapse, silos that run out and bear,
// heaps and bodies that rest, momentum; and that a run goes on from an image, at every width and number of threads, with the same bits.
// PLUMB_LONG
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>

#include <cmocka.h>

#include "harness/near.h"
#include "harness/sim.h"
#include "harness/tank.h"

#define HZ60     (1 / 60.0)
#define FRICTION 0.6
#define G        10.0

static void check_between(double value, double low, double high)
{
    if (!(value >= low && value <= high)) {
        print_error("%g is not between %g and %g\n", value, low, high);
        fail();
    }
}

static plumb_world *make_world(double gravity_x, double gravity_y)
{
    return sim_world(&(plumb_world_desc){ .gravity = sim_vec(gravity_x, gravity_y) });
}

static void make_sand(plumb_world *w, double spacing, double density, double friction)
{
    assert_int_equal(
        plumb_liquid_create(w, &(plumb_liquid_desc){ .spacing = (plumb_real)spacing,
                                                     .density = (plumb_real)density,
                                                     .friction = (plumb_real)friction }),
        PLUMB_OK);
}

//---- a layer on a slope --------------------------------------------------------------------------

// Mean velocity [m/s] of the middle of a layer of 0.5 m after half a second, gravity inclined against the floor by a slope, both
// turned by `turn` in the world.
static double speed_on(double slope, double spacing, double turn)
{
    const double angle = atan(slope), c = cos(turn), s = sin(turn);
    plumb_world *w = make_world(G * sin(angle - turn), -G * cos(angle - turn));
    const plumb_body floor = sim_body(w, PLUMB_STATIC, s * 0.5, -c * 0.5, -turn);
    const plumb_material none = PLUMB_NULL_INIT;
    sim_add_box(w, floor, 30, 0.5, none);
    make_sand(w, spacing, 1600, FRICTION);
    const double x[] = { -5, 5, 4, -4 }, y[] = { 0, 0, 0.5, 0.5 };
    plumb_vec2 corners[4];
    for (int i = 0; i < 4; ++i) {
        corners[i] = sim_vec(x[i] * c + y[i] * s, y[i] * c - x[i] * s);
    }
    assert_int_equal(plumb_liquid_add_shape(w, corners, 4, NULL), PLUMB_OK);
    sim_run(w, 30, HZ60);
    int count, middle = 0;
    double sum = 0;
    const plumb_particle *p = plumb_liquid_particles(w, &count);
    for (int i = 0; i < count; ++i) {
        const double along = (double)p[i].position.x * c - (double)p[i].position.y * s;
        if (fabs(along) < 1) {
            sum += (double)p[i].velocity.x * c - (double)p[i].velocity.y * s;
            ++middle;
        }
    }
    plumb_world_destroy(w);
    return sum / middle;
}

static void layers_rest_below_their_friction(void **state)
{
    (void)state;
    const double turns[] = { 0, 0.3, -0.7 };
    for (int i = 0; i < 3; ++i) {
        const double gentle = speed_on(0.3, 0.05, turns[i]), steep = speed_on(0.5, 0.05, turns[i]);
        print_message("slopes of 0.3, 0.5 at friction 0.6, turned by %g: %.2g, %.2g m/s\n",
                      turns[i], gentle, steep);
        assert_true(fabs(gentle) < 1e-3 && fabs(steep) < 1e-2);
    }
}

// All of it is at its bound, so all of it gains g (sin - friction cos).
static void layers_slip_above_it(void **state)
{
    (void)state;
    const double slopes[] = { 0.8, 1.2 };
    for (int i = 0; i < 2; ++i) {
        const double angle = atan(slopes[i]);
        const double theory = 0.5 * G * (sin(angle) - FRICTION * cos(angle));
        double error[3];
        for (int k = 0; k < 3; ++k) {
            error[k] = 1 - speed_on(slopes[i], 0.05 / (1 << k), 0) / theory;
        }
        print_message(
            "slope %g: slower than theory by %.3f, %.3f, %.3f at 5, 10, 20 cells, order %.2f\n",
            slopes[i], error[0], error[1], error[2], sim_order(error, 3));
        assert_true(error[2] < 0.12 && error[2] > -0.02 && sim_order(error, 3) > 0.8);
    }
}

//---- columns and heaps ---------------------------------------------------------------------------

// What the particles of a heap over x = 0 are like: the half width that holds 98 % of them, the highest, their rms speed there.
typedef struct heap {
    double half, top, rms;
} heap;

static int compare(const void *a, const void *b)
{
    const double x = *(const double *)a, y = *(const double *)b;
    return x < y ? -1 : x > y;
}

static heap look(const plumb_world *w)
{
    int count, within = 0;
    heap h = { 0, 0, 0 };
    const plumb_particle *p = plumb_liquid_particles(w, &count);
    double *x = malloc((size_t)count * sizeof *x);
    assert_non_null(x);
    for (int i = 0; i < count; ++i) {
        x[i] = fabs((double)p[i].position.x);
        h.top = fmax(h.top, (double)p[i].position.y);
    }
    qsort(x, (size_t)count, sizeof *x, compare);
    h.half = x[(size_t)(0.98 * count)];
    free(x);
    for (int i = 0; i < count; ++i) {
        if (fabs((double)p[i].position.x) < h.half) {
            const double u = (double)p[i].velocity.x, v = (double)p[i].velocity.y;
            h.rms += u * u + v * v;
            ++within;
        }
    }
    h.rms = sqrt(h.rms / within);
    return h;
}

static plumb_world *make_ground(double spacing, double friction)
{
    plumb_world *w = make_world(0, -G);
    tank_wall(w, 0, -0.5, 40, 0.5);
    make_sand(w, spacing, 1600, friction);
    return w;
}

// Columns as wide as 2 L and a L high end 1.2 a L wider on each side (Lube et al. 2005), and L a^(1/3) high (Lajeunesse et al. 2005),
// whatever their friction is.
static void columns_collapse(void **state)
{
    (void)state;
    const double aspects[] = { 1, 2, 3 }, l = 0.5;
    for (int i = 0; i < 3; ++i) {
        plumb_world *w = make_ground(0.0125, FRICTION);
        tank_fill(w, -l, 0, l, aspects[i] * l);
        sim_run(w, 240, HZ60);
        const heap h = look(w);
        const double wide = (h.half - l) / l / (1.2 * aspects[i]),
                     high = h.top / l / cbrt(aspects[i]);
        print_message("column of %g: 98 %% within %.2f of its way, height %.2f of experiments'\n",
                      aspects[i], wide, high);
        check_between(wide, 0.7, 1.1);
        check_between(high, 0.85, 1.15);
        plumb_world_destroy(w);
    }
}

static void heaps_rest(void **state)
{
    (void)state;
    plumb_world *w = make_ground(0.05, FRICTION);
    const plumb_vec2 gentle[] = { sim_vec(-2, 0), sim_vec(2, 0), sim_vec(0, 0.8) };
    assert_int_equal(plumb_liquid_add_shape(w, gentle, 3, NULL), PLUMB_OK);
    const heap before = look(w);
    sim_run(w, 600, HZ60);
    const heap after = look(w);
    print_message(
        "a heap of slope 0.4 after 10 s: half %.4f of %.4f m, top %.4f of %.4f m, %.2g m/s\n",
        after.half, before.half, after.top, before.top, after.rms);
    assert_near(after.half, before.half, 0.01);
    assert_near(after.top, before.top, 0.01);
    assert_true(after.rms < 2e-3);
    plumb_world_destroy(w);
}

// Behind particles that go, what grains bear stays theirs: else the heap would start to move.
static void heaps_rest_when_others_go(void **state)
{
    (void)state;
    plumb_world *w = make_ground(0.05, FRICTION);
    const plumb_vec2 other[] = { sim_vec(8, 0), sim_vec(12, 0), sim_vec(10, 0.8) };
    const plumb_vec2 kept[] = { sim_vec(-2, 0), sim_vec(2, 0), sim_vec(0, 0.8) };
    assert_int_equal(plumb_liquid_add_shape(w, other, 3, NULL), PLUMB_OK);
    assert_int_equal(plumb_liquid_add_shape(w, kept, 3, NULL), PLUMB_OK);
    sim_run(w, 120, HZ60);
    assert_true(plumb_liquid_remove(w, sim_vec(6, -1), sim_vec(14, 2)) > 500);
    double most = 0;
    for (int i = 0; i < 30; ++i) {
        sim_step(w, HZ60);
        most = fmax(most, look(w).rms);
    }
    print_message("a heap whose neighbour was taken away: at most %.2g m/s\n", most);
    assert_true(most < 2e-3);
    plumb_world_destroy(w);
}

//---- silos ---------------------------------------------------------------------------------------

// [m^2/s] that runs out of a hole in the floor of a silo 2 m wide, over half a second from `from` [s] on.
static double rate_of(double friction, double hole, double from)
{
    plumb_world *w = make_world(0, -G);
    const double side = 1 - hole / 2;
    tank_wall(w, -1.5, 2, 0.5, 4);
    tank_wall(w, 1.5, 2, 0.5, 4);
    tank_wall(w, -(1 + hole / 2) / 2, -0.1, side / 2, 0.1);
    tank_wall(w, (1 + hole / 2) / 2, -0.1, side / 2, 0.1);
    make_sand(w, 0.025, 1600, friction);
    tank_fill(w, -1, 0, 1, 3);
    int gone = 0;
    for (int i = 0; i < (int)(60 * from) + 30; ++i) {
        sim_step(w, HZ60);
        const int removed = plumb_liquid_remove(w, sim_vec(-9, -9), sim_vec(9, -1));
        gone += i >= (int)(60 * from) ? removed : 0;
    }
    plumb_world_destroy(w);
    return gone * 0.025 * 0.025 / 0.5;
}

// Q = C sqrt(g) hole^(3/2), C about 1.4 in a plane, whatever is above (Beverloo et al. 1961; Staron, Lagree, Popinet 2012); water
// runs by the root of its depth.
static void silos_run_evenly(void **state)
{
    (void)state;
    const double full = rate_of(FRICTION, 0.4, 1), half = rate_of(FRICTION, 0.4, 3);
    const double wide = rate_of(FRICTION, 0.8, 1);
    const double water = rate_of(0, 0.4, 2.5) / rate_of(0, 0.4, 1);
    const double scale = sqrt(G) * pow(0.4, 1.5);
    print_message("C %.2f full, %.2f half empty; a hole twice as wide: %.2f of 2^(3/2); water, "
                  "half empty: %.2f\n",
                  full / scale, half / scale, wide / full / pow(2, 1.5), water);
    check_between(full / scale, 1.1, 1.7);
    check_between(half / full, 0.85, 1.25);
    check_between(wide / full / pow(2, 1.5), 0.85, 1.25);
    assert_true(water < 0.8);
}

// [N] on a floor 0.5 m wide that hangs between two walls.
static double load_of(double friction, double depth)
{
    const plumb_material none = PLUMB_NULL_INIT;
    plumb_world *w = make_world(0, -G);
    tank_wall(w, -0.75, 4, 0.5, 5);
    tank_wall(w, 0.75, 4, 0.5, 5);
    const plumb_body floor = sim_body(w, PLUMB_DYNAMIC, 0, -0.3, 0);
    assert_false(plumb_is_null(plumb_shape_create(
        w, floor,
        &(plumb_shape_desc){
            .kind = PLUMB_BOX, .half = sim_vec(0.25, 0.3), .density = 20000, .material = none })));
    sim_joint(
        w, (plumb_joint_desc){ .kind = PLUMB_WELD, .body_b = floor, .anchor = sim_vec(0, -0.3) });
    make_sand(w, 0.0125, 1000, friction);
    tank_fill(w, -0.25, 0, 0.25, depth);
    sim_run(w, 180, HZ60);
    double sum = 0;
    for (int i = 0; i < 60; ++i) {
        sim_step(w, HZ60);
        int count;
        const plumb_liquid_contact *c = plumb_liquid_contacts(w, &count);
        assert_int_equal(count, 1);
        sum -= (double)c->force.y / 60;
    }
    plumb_world_destroy(w);
    return sum;
}

// Stress on the floor: density g W / (2 friction K) (1 - exp(-2 friction K depth / W)) (Janssen 1895), with K, of stresses along over
// across, between 1 / (1 + 2 friction^2) at a wall that slips and 1.
static void silos_bear(void **state)
{
    (void)state;
    assert_near(load_of(0, 1) / (1000 * G * 0.5), 1, 0.01);
    const double depths[] = { 1, 2, 4 };
    double load[3];
    for (int i = 0; i < 3; ++i) {
        load[i] = load_of(FRICTION, depths[i]);
        const double low = 2 * FRICTION * depths[i] / 0.5,
                     high = low / (1 + 2 * FRICTION * FRICTION);
        const double most = (1 - exp(-high)) / high, least = (1 - exp(-low)) / low;
        const double share = load[i] / (1000 * G * 0.5 * depths[i]);
        print_message("%g m deep: the floor bears %.3f, Janssen %.3f to %.3f\n", depths[i], share,
                      least, most);
        check_between(share, 0.92 * least, most);
    }
    assert_near(load[2] / load[1], 1, 0.1);
}

//---- bodies --------------------------------------------------------------------------------------

// Boxes of a thousandth to twice the sand's density fall on it aslant.
static void bodies_rest_on_it(void **state)
{
    (void)state;
    const double densities[] = { 3200, 1600, 400, 100, 16, 1.6 };
    for (int i = 0; i < 6; ++i) {
        plumb_world *w = tank_make(4, 3, 0.05);
        plumb_liquid_set(w,
                         &(plumb_liquid_desc){ .density = 1600, .friction = (plumb_real)FRICTION });
        tank_fill(w, 0, 0, 4, 1.5);
        const plumb_body b = sim_body(w, PLUMB_DYNAMIC, 2.013, 2.3, 0.2);
        plumb_shape_create(w, b,
                           &(plumb_shape_desc){ .kind = PLUMB_BOX,
                                                .half = sim_vec(0.4, 0.4),
                                                .density = (plumb_real)densities[i] });
        double most = 0, late = 0;
        for (int n = 0; n < 600; ++n) {
            sim_step(w, HZ60);
            const double speed = hypot(sim_vx(w, b), sim_vy(w, b)) + fabs(sim_w(w, b));
            most = fmax(most, speed);
            late = n >= 540 ? fmax(late, speed) : late;
        }
        print_message("box of %g on sand of 1600: at most %.2f m/s, after 9 s %.2g, at %.3f m\n",
                      densities[i], most, late, sim_y(w, b));
        assert_true(most < 5 && late < 0.05);
        check_between(sim_y(w, b), 1.6, 2.05);
        plumb_world_destroy(w);
    }
}

static double momentum_of(const plumb_world *w, plumb_body b, double density, double spacing)
{
    int count;
    const plumb_particle *p = plumb_liquid_particles(w, &count);
    double sum = (double)plumb_body_mass(w, b) * sim_vx(w, b);
    for (int i = 0; i < count; ++i) {
        sum += density * spacing * spacing * (double)p[i].velocity.x;
    }
    return sum;
}

// A block of sand is shot at a box in space: both go on together. Faces at its edges have another mass than the particles beside them.
static void momentum_is_kept(void **state)
{
    (void)state;
    const double densities[] = { 3200, 160, 16 };
    for (int i = 0; i < 3; ++i) {
        plumb_world *w = sim_space();
        make_sand(w, 0.05, 1600, FRICTION);
        plumb_liquid_add_box(w, sim_vec(-1.6, -0.5), sim_vec(-0.6, 0.5),
                             &(plumb_particle){ .velocity = sim_vec(3, 0) });
        const plumb_body b = sim_body(w, PLUMB_DYNAMIC, 0, 0.1, 0.3);
        plumb_shape_create(w, b,
                           &(plumb_shape_desc){ .kind = PLUMB_BOX,
                                                .half = sim_vec(0.5, 0.5),
                                                .density = (plumb_real)densities[i] });
        const double before = momentum_of(w, b, 1600, 0.05);
        sim_run(w, 60, HZ60);
        const double lost = 1 - momentum_of(w, b, 1600, 0.05) / before;
        print_message(
            "sand meets a box of %g in space, which has %.2f m/s then: lost %.2g of the momentum\n",
            densities[i], sim_vx(w, b), lost);
        assert_true(sim_vx(w, b) > 0.3 && fabs(lost) < 0.06);
        plumb_world_destroy(w);
    }
}

//---- the same bits -------------------------------------------------------------------------------

static plumb_world *make_slide(int width, int workers)
{
    plumb_world *w = sim_world(&(plumb_world_desc){ .simd_width = width, .workers = workers });
    tank_wall(w, 0, -0.5, 10, 0.5);
    plumb_liquid_create(w, &(plumb_liquid_desc){ .spacing = PLUMB_REAL(0.04) });
    const plumb_liquid_phase sand = { .density = 1600, .friction = PLUMB_REAL(0.6) };
    assert_int_equal(plumb_liquid_set_phases(w, &sand, 1), PLUMB_OK);
    plumb_liquid_add_box(w, sim_vec(-1, 0), sim_vec(0, 1), &(plumb_particle){ .phase = 1 });
    plumb_liquid_add_box(w, sim_vec(0, 0), sim_vec(1, 0.5), NULL);
    sim_crate(w, -0.5, 1.3, 0.2, 0.2, (plumb_material)PLUMB_NULL_INIT);
    return w;
}

static void bits_are_the_same(void **state)
{
    (void)state;
    plumb_world *first = make_slide(4, 1);
    sim_run(first, 40, HZ60);
    const size_t size = plumb_world_snapshot_size(first);
    void *image = malloc(size);
    assert_non_null(image);
    assert_int_equal(plumb_world_save(first, image, size), PLUMB_OK);
    sim_run(first, 40, HZ60);
    for (int i = 0; i < 4; ++i) {
        plumb_world *other = make_slide(i < 3 ? 4 << i : 8, i < 3 ? 1 : 2);
        if (i == 1) { // goes on from the image, in another world
            assert_int_equal(plumb_world_restore(other, image, size), PLUMB_OK);
            sim_run(other, 40, HZ60);
        } else {
            sim_run(other, 80, HZ60);
        }
        assert_true(plumb_world_hash(other) == plumb_world_hash(first));
        plumb_world_destroy(other);
    }
    free(image);
    plumb_world_destroy(first);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(layers_rest_below_their_friction),
        cmocka_unit_test(layers_slip_above_it),
        cmocka_unit_test(columns_collapse),
        cmocka_unit_test(heaps_rest),
        cmocka_unit_test(heaps_rest_when_others_go),
        cmocka_unit_test(silos_run_evenly),
        cmocka_unit_test(silos_bear),
        cmocka_unit_test(bodies_rest_on_it),
        cmocka_unit_test(momentum_is_kept),
        cmocka_unit_test(bits_are_the_same),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
