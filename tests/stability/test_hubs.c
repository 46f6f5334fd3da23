// test_hubs.c - bodies that many hang on: joints make no energy, however heavy what hangs there is (src/joints/hub.c).
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "harness/sim.h"
#include "harness/trials.h"

#define HZ60 (1 / 60.0)

enum { HINGE_MOTOR = 5, WHEEL_MOTOR = 4 }; // their rows

#define ANY ((plumb_joint_kind)-1)

// A tree of bodies that turns as one at 1 rad/s, in space: kinds of joints, masses and places at random.
typedef struct tree {
    plumb_world *world;
    plumb_body body[32];
    int count;
} tree;

static plumb_joint_kind any_kind(uint32_t *seed)
{
    static const plumb_joint_kind kinds[] = { PLUMB_WELD,     PLUMB_WELD,  PLUMB_REVOLUTE,
                                              PLUMB_REVOLUTE, PLUMB_MOTOR, PLUMB_PRISMATIC,
                                              PLUMB_WHEEL };
    return kinds[(int)sim_uniform(seed, 0, sizeof kinds / sizeof kinds[0])];
}

static plumb_body add_body(tree *t, uint32_t *seed, double x, double y)
{
    const double kg = pow(10, sim_uniform(seed, -1, 1)), radius = sim_uniform(seed, 0.05, 0.7);
    const plumb_body b = sim_mass(t->world, x, y, kg, kg * radius * radius);
    plumb_body_set_velocity(t->world, b, sim_vec(-y, x));
    plumb_body_set_angular_velocity(t->world, b, 1);
    return t->body[t->count++] = b;
}

// Hangs a body on one of those that there are.
static void grow(tree *t, uint32_t *seed, plumb_body on, plumb_joint_kind kind)
{
    const double angle = sim_uniform(seed, 0, 2 * SIM_PI), turn = sim_uniform(seed, -0.5, 0.5);
    const double near = sim_uniform(seed, 0.1, 0.5), far = sim_uniform(seed, 0.1, 1.5);
    const double x = sim_x(t->world, on) + near * cos(angle);
    const double y = sim_y(t->world, on) + near * sin(angle);
    const plumb_body b =
        add_body(t, seed, x + far * cos(angle + turn), y + far * sin(angle + turn));
    plumb_joint_desc d = { .kind = kind, .body_a = on, .body_b = b, .anchor = sim_vec(x, y) };
    if (kind == PLUMB_PRISMATIC || kind == PLUMB_WHEEL) {
        d.axis = sim_vec(cos(angle), sin(angle));
    }
    sim_joint(t->world, d);
}

static double kinetic(const tree *t)
{
    return (double)plumb_world_energy(t->world).kinetic;
}

// The most that its energy grows by in 3 s, over what it begins with.
static double growth(tree *t)
{
    const double before = kinetic(t);
    double most = 0;
    for (int i = 0; i < 180; ++i) {
        sim_step(t->world, HZ60);
        most = fmax(most, kinetic(t) / before - 1);
    }
    return most;
}

// `kind`: of all joints, or ANY.
static void try_trees(bool stars, plumb_joint_kind kind)
{
    const trials tried = trials_from(1, 150);
    const unsigned count = tried.end - tried.first;
    int grew = 0;
    double worst = 0;
    for (uint32_t i = tried.first; i < tried.end; ++i) {
        uint32_t seed = 7919 * i;
        const int substeps[] = { 4, 1, 2, 8, 16 };
        tree t = { .world = sim_world(&(plumb_world_desc){
                       .zero_gravity = true, .no_sleep = true, .substeps = substeps[i % 5] }) };
        add_body(&t, &seed, sim_uniform(&seed, -1, 1), sim_uniform(&seed, -1, 1));
        const int bodies = 4 + (int)sim_uniform(&seed, 0, stars ? 6 : 20);
        while (t.count < bodies) {
            const plumb_body on = t.body[stars ? 0 : (int)sim_uniform(&seed, 0, t.count)];
            grow(&t, &seed, on, kind == ANY ? any_kind(&seed) : kind);
        }
        const double by = growth(&t);
        if (!(by < 0.02)) {
            print_message("%s %u, %d bodies, %d substeps: energy grows by %.3g\n",
                          stars ? "star" : "tree", i, t.count, substeps[i % 5], by);
            ++grew;
        }
        worst = fmax(worst, by);
        plumb_world_destroy(t.world);
    }
    print_message("%u %s: energy grows by %.3g at most\n", count, stars ? "stars" : "trees", worst);
    assert_int_equal(grew, 0);
}

static void stars_make_no_energy(void **state)
{
    (void)state;
    try_trees(true, ANY);
}

static void trees_make_no_energy(void **state)
{
    (void)state;
    try_trees(false, ANY);
}

// Wheels without spring and limit slide out of reach, and what they bear gets arms as long.
static void what_slides_freely_makes_no_energy(void **state)
{
    (void)state;
    try_trees(true, PLUMB_WHEEL);
    try_trees(false, PLUMB_WHEEL);
}

// A star of arms that motors drive, one after the other way round: who is at its bound is found whichever bound it is,
// and one that may give nothing gives nothing. Returns by how much a motor exceeds its bound at the most, as a share.
static double excess_of_motors(uint32_t seed)
{
    plumb_world *w = sim_world(&(plumb_world_desc){ .zero_gravity = sim_uniform(&seed, 0, 2) < 1 });
    const plumb_body hub = sim_mass(w, 0, 0, 0.3, 0.01);
    const int arms = 4 + (int)sim_uniform(&seed, 0, 4);
    const bool idle = sim_uniform(&seed, 0, 4) < 1; // motors that may give nothing
    plumb_joint joint[8];
    double most[8], worst = 0;
    for (int i = 0; i < arms; ++i) {
        const double angle = 2 * SIM_PI * i / arms, far = sim_uniform(&seed, 0.3, 1);
        const double x = cos(angle), y = sin(angle), kg = sim_uniform(&seed, 0.1, 2);
        const plumb_body arm =
            sim_mass(w, (0.3 + far) * x, (0.3 + far) * y, kg, kg * far * far / 3);
        most[i] = idle ? 0 : sim_uniform(&seed, 0.01, 5);
        joint[i] =
            sim_joint(w, (plumb_joint_desc){ .kind = i % 3 == 2 ? PLUMB_WHEEL : PLUMB_REVOLUTE,
                                             .body_a = hub,
                                             .body_b = arm,
                                             .anchor = sim_vec(0.3 * x, 0.3 * y),
                                             .axis = i % 3 == 2 ? sim_vec(x, y) : sim_vec(0, 0),
                                             .enable_motor = true,
                                             .motor_speed = (plumb_real)sim_uniform(&seed, -8, 8),
                                             .max_motor = (plumb_real)most[i] });
    }
    for (int step = 0; step < 30; ++step) {
        sim_step(w, HZ60);
        for (int i = 0; i < arms; ++i) {
            plumb_joint_memory memory;
            plumb_joint_get_memory(w, joint[i], &memory);
            const double torque =
                fabs((double)memory.impulses[i % 3 == 2 ? WHEEL_MOTOR : HINGE_MOTOR]) /
                (double)memory.substep;
            worst = fmax(worst, (torque - most[i]) / (most[i] + 1e-6));
        }
    }
    plumb_world_destroy(w);
    return worst;
}

static void motors_give_no_more_than_they_may(void **state)
{
    (void)state;
    const trials tried = trials_from(1, 300);
    const unsigned count = tried.end - tried.first;
    int over = 0;
    double worst = 0;
    for (uint32_t i = tried.first; i < tried.end; ++i) {
        const double excess = excess_of_motors(104729 * i);
        over += !(excess < 1e-5);
        worst = fmax(worst, excess);
    }
    print_message("%d of %u stars have motors that give too much, by %.3g of it\n", over, count,
                  worst);
    assert_int_equal(over, 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(stars_make_no_energy),
        cmocka_unit_test(trees_make_no_energy),
        cmocka_unit_test(what_slides_freely_makes_no_energy),
        cmocka_unit_test(motors_give_no_more_than_they_may),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
