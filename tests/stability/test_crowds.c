// test_crowds.c - crowds of all shapes, masses and joints in a box, at default settings: nothing gives them energy, so none rises;
// nobody leaves the box or is lost.
// PLUMB_LONG
#include "harness/near.h"
#include "harness/sim.h"
#include "harness/trials.h"

#include <math.h>

#define MOST  60
#define WIDE  8.0 // [m] half of the box
#define STEPS 400
#define NONE  (-1) // joints
#define HZ60  (1.0 / 60)

static uint32_t seed;

static double between(double low, double high)
{
    return sim_uniform(&seed, low, high);
}

static void add_shape(plumb_world *w, plumb_body b, plumb_material m)
{
    static const plumb_vec2 ends[2] = { { (plumb_real)-0.3, 0 }, { (plumb_real)0.3, 0 } };
    const int kind = (int)between(0, 3);
    if (kind == 0) {
        sim_add_box(w, b, between(0.1, 0.6), between(0.1, 0.6), m);
    } else if (kind == 1) {
        sim_add_circle(w, b, between(0.1, 0.8), m);
    } else {
        const plumb_shape s =
            plumb_shape_create(w, b,
                               &(plumb_shape_desc){ .kind = PLUMB_CAPSULE,
                                                    .points = ends,
                                                    .count = 2,
                                                    .radius = (plumb_real)between(0.05, 0.3),
                                                    .material = m });
        assert_false(plumb_is_null(s.entity));
    }
}

static void add_walls(plumb_world *w, plumb_material m)
{
    const double half[4][4] = {
        { 0, -1, 9, 1 }, { 0, 19, 9, 1 }, { -9, 9, 1, 11 }, { 9, 9, 1, 11 }
    };
    for (int i = 0; i < 4; ++i) {
        const plumb_body wall = sim_body(w, PLUMB_STATIC, half[i][0], half[i][1], 0);
        sim_add_box(w, wall, half[i][2], half[i][3], m);
    }
}

// Bodies in rows of eight, masses up to `spread` : 1, every second neighbour joined.
static plumb_world *crowd(double spread, int joint, double restitution)
{
    plumb_world *w = sim_world(&(plumb_world_desc){ 0 });
    const plumb_material m = plumb_material_create(
        w, &(plumb_material_desc){ .friction = (plumb_real)between(0, 1),
                                   .restitution = (plumb_real)(restitution * between(0, 1)),
                                   .rolling_resistance =
                                       (plumb_real)(between(0, 1) < 0.3 ? between(0, 0.05) : 0) });
    add_walls(w, m);
    const int count = (int)between(10, MOST);
    plumb_body before = PLUMB_NULL_INIT;
    for (int i = 0; i < count; ++i) {
        const double x = -7 + 2 * (i % 8), y = 1 + 2 * (i / 8);
        const plumb_body b = plumb_body_create(
            w, &(plumb_body_desc){ .position = sim_vec(x, y),
                                   .angle = (plumb_real)between(-3, 3),
                                   .velocity = sim_vec(between(-5, 5), between(-5, 5)),
                                   .angular_velocity = (plumb_real)between(-8, 8) });
        add_shape(w, b, m);
        plumb_body_set_mass(w, b, (plumb_real)pow(spread, between(0, 1)));
        if (joint != NONE && i % 8 != 0 && between(0, 1) < 0.5) {
            const plumb_joint_desc d = { .kind = (plumb_joint_kind)joint,
                                         .body_a = before,
                                         .body_b = b,
                                         .anchor = sim_vec(x - 1, y),
                                         .anchor_b = joint == PLUMB_DISTANCE ? sim_vec(x, y)
                                                                             : sim_vec(0, 0) };
            assert_false(plumb_is_null(plumb_joint_create(w, &d).entity));
        }
        before = b;
    }
    return w;
}

// [-] of the energy at the start, by which it rose above the least that it had had.
static double rise_of(plumb_world *w)
{
    sim_step(w, HZ60); // joints take their share of velocities that contradict them
    const double start = sim_energy(w);
    double least = start, rise = 0;
    for (int i = 0; i < STEPS; ++i) {
        sim_step(w, HZ60);
        const double now = sim_energy(w);
        rise = fmax(rise, (now - least) / start);
        least = fmin(least, now);
    }
    const plumb_body_span s = plumb_world_bodies(w);
    for (int i = 0; i < s.count - s.static_count; ++i) {
        assert_true(fabs((double)s.center_x[i]) < WIDE + 0.5 && (double)s.center_y[i] > -0.5 &&
                    (double)s.center_y[i] < 18.5);
    }
    return rise;
}

static void no_crowd_gains_energy(void **state)
{
    (void)state;
    static const struct {
        double spread, most;
    } masses[] = { { 1.01, 0.03 }, { 30, 0.1 } };
    static const int joints[] = { NONE,       PLUMB_REVOLUTE, PLUMB_PRISMATIC,
                                  PLUMB_WELD, PLUMB_WHEEL,    PLUMB_DISTANCE };
    const trials t = trials_from(1, 4);
    for (size_t i = 0; i < sizeof masses / sizeof masses[0]; ++i) {
        for (size_t k = 0; k < sizeof joints / sizeof joints[0]; ++k) {
            double worst = 0;
            for (uint32_t n = t.first; n < t.end; ++n) {
                seed = n * 7919;
                plumb_world *w = crowd(masses[i].spread, joints[k], n % 2 == 0 ? 0.9 : 0);
                const double rise = rise_of(w);
                worst = fmax(worst, rise);
                if (rise > masses[i].most) {
                    print_error("crowd %d, joints %d, 1 : %g: %.3g of the energy more\n", (int)n,
                                joints[k], masses[i].spread, rise);
                }
                plumb_world_destroy(w);
            }
            print_message("joints %2d, 1 : %g: %.2g of the energy more at most\n", joints[k],
                          masses[i].spread, worst);
            assert_true(worst <= masses[i].most);
        }
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = { cmocka_unit_test(no_crowd_gains_energy) };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
