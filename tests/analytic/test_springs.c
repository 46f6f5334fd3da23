// test_springs.c - springs told by stiffness and damper, against closed forms; and that those in hertz, which test_joints.c
// measures, are springs: their stiffness stays, and they make no energy.
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "harness/near.h"
#include "harness/sim.h"
#include "harness/trials.h"

#define DT (1 / 60.0)

static double value(const plumb_world *w, plumb_joint j)
{
    return (double)plumb_joint_value(w, j);
}

// A damper alone: v falls by exp(-c t / m), however strong it is.
static void dampers_brake_by_their_exponential(void **state)
{
    (void)state;
    const double dampers[] = { 0.5, 6, 60, 6000 };
    for (size_t k = 0; k < sizeof dampers / sizeof dampers[0]; ++k) {
        const double kg = 2, c = dampers[k], v = 3;
        plumb_world *w = sim_world(&(plumb_world_desc){ .zero_gravity = true, .no_sleep = true });
        plumb_body b = sim_mass(w, 1, 0, kg, 0.1);
        sim_joint(w, (plumb_joint_desc){ .kind = PLUMB_PRISMATIC,
                                         .body_b = b,
                                         .anchor = sim_vec(1, 0),
                                         .damper = (plumb_real)c });
        sim_launch(w, b, v, 0, 0);
        double worst = 0;
        for (int i = 1; i <= 120; ++i) {
            sim_step(w, DT);
            const double way = v * kg / c * (1 - exp(-c / kg * i * DT));
            worst = fmax(worst, fabs(sim_x(w, b) - 1 - way));
        }
        print_message("damper of %g N s/m: within %.2g m in 2 s\n", c, worst);
        assert_true(worst < SIM_TOLERANCE(2e-5, 1e-9));
        plumb_world_destroy(w);
    }
}

// Time of five full swings about `middle` of what `j` has as its value.
static double five_swings(plumb_world *w, plumb_joint j, double middle)
{
    double last = value(w, j) - middle, first = 0, at = 0, t = 0;
    for (int crossings = 0; crossings < 11 && t < 60; t += DT) {
        sim_step(w, DT);
        const double now = value(w, j) - middle;
        if ((now > 0) != (last > 0)) {
            at = t + DT * last / (last - now);
            first = crossings++ == 0 ? at : first;
        }
        last = now;
    }
    return at - first;
}

// A spring in newtons pulls with the same force whatever it holds: four times the mass swings half as fast. One in hertz
// keeps its frequency.
static void stiffness_stays_when_the_mass_changes(void **state)
{
    (void)state;
    for (int newtons = 0; newtons < 2; ++newtons) {
        plumb_world *w = sim_world(&(plumb_world_desc){ .zero_gravity = true, .no_sleep = true });
        plumb_body b = sim_mass(w, 2.2, 0, 1, 0);
        plumb_joint j = sim_joint(w, (plumb_joint_desc){ .kind = PLUMB_DISTANCE,
                                                         .body_b = b,
                                                         .anchor_b = sim_vec(2.2, 0),
                                                         .length = 2,
                                                         .hertz = (plumb_real)(newtons ? 0 : 1) });
        if (newtons) {
            assert_int_equal(
                plumb_joint_set_stiffness(w, j, (plumb_real)(4 * SIM_PI * SIM_PI), 0, 0), PLUMB_OK);
        }
        const double before = five_swings(w, j, 2) / 5;
        assert_int_equal(plumb_body_set_mass(w, b, 4), PLUMB_OK);
        const double after = five_swings(w, j, 2) / 5;
        print_message("spring in %s: period %.6f s, with four times the mass %.6f s\n",
                      newtons ? "newtons" : "hertz", before, after);
        assert_near(before, 1, 1e-3);
        assert_near(after, newtons ? 2 : 1, 2e-3);
        plumb_world_destroy(w);
    }
}

// [N m/rad] about a hinge at a rod's end: the rod turns with I + m r^2; and a rod that two springs hold beside its centre.
static void springs_in_newtons_turn_what_they_hold(void **state)
{
    (void)state;
    plumb_world *w = sim_world(&(plumb_world_desc){ .zero_gravity = true, .no_sleep = true });
    const double kg = 2, inertia = 0.4, arm = 0.7, stiffness = 30;
    plumb_body rod = sim_mass(w, arm, 0, kg, inertia);
    plumb_joint hinge = sim_joint(w, (plumb_joint_desc){ .kind = PLUMB_REVOLUTE,
                                                         .body_b = rod,
                                                         .stiffness = (plumb_real)stiffness });
    sim_launch(w, rod, 0, 0.5 * arm, 0.5);
    const double exact = 2 * SIM_PI * sqrt((inertia + kg * arm * arm) / stiffness);
    const double period = five_swings(w, hinge, 0) / 5;
    print_message("rod on a hinge of %g N m/rad: period %.6f s, exact %.6f\n", stiffness, period,
                  exact);
    assert_near(period / exact, 1, 1e-3);
    plumb_world_destroy(w);
}

// What a load stretches: m g / k, of each kind with a spring, by each solver.
static void loads_stretch_springs_in_newtons(void **state)
{
    (void)state;
    const plumb_joint_kind kinds[] = { PLUMB_PRISMATIC, PLUMB_WHEEL, PLUMB_DISTANCE, PLUMB_MOUSE,
                                       PLUMB_MOTOR };
    const plumb_solver solvers[] = { PLUMB_SOLVER_SOFT, PLUMB_SOLVER_PGS, PLUMB_SOLVER_EXACT };
    const double kg = 5, stiffness = 200, exact = kg * SIM_G / stiffness;
    for (size_t i = 0; i < 15; ++i) {
        const plumb_joint_kind kind = kinds[i % 5];
        plumb_world *w =
            sim_world(&(plumb_world_desc){ .solver = solvers[i / 5], .no_sleep = true });
        plumb_body b = sim_mass(w, 0, -2, kg, 1);
        plumb_joint_desc d = { .kind = kind,
                               .body_b = b,
                               .anchor = sim_vec(0, kind == PLUMB_DISTANCE ? 0 : -2),
                               .stiffness = (plumb_real)stiffness,
                               .damper = 40 };
        d.anchor_b = sim_vec(0, kind == PLUMB_DISTANCE ? -2 : 0);
        d.axis = sim_vec(0, kind == PLUMB_PRISMATIC || kind == PLUMB_WHEEL ? 1 : 0);
        sim_joint(w, d);
        sim_run(w, 900, DT);
        const double sag = -2 - sim_y(w, b);
        print_message("%s, solver %d: %.7f m, exact %.7f\n", plumb_joint_kind_name(kind),
                      (int)solvers[i / 5], sag, exact);
        assert_near(sag / exact, 1, 2e-6);
        plumb_world_destroy(w);
    }
}

// Bodies that tumble, each hung on one of those before it, with springs beside their centres.
typedef struct tumble {
    plumb_world *world;
    plumb_body body[12];
    int count;
} tumble;

static void add_body(tumble *t, uint32_t *seed, double x, double y)
{
    const double kg = pow(10, sim_uniform(seed, -1, 1)), radius = sim_uniform(seed, 0.05, 0.7);
    const plumb_body b = sim_mass(t->world, x, y, kg, kg * radius * radius);
    sim_launch(t->world, b, sim_uniform(seed, -0.5, 0.5) - y, x + sim_uniform(seed, -0.5, 0.5),
               sim_uniform(seed, 0, 2));
    t->body[t->count++] = b;
}

static void hang_body(tumble *t, uint32_t *seed, plumb_joint_kind kind, double damping)
{
    const plumb_body on = t->body[(int)sim_uniform(seed, 0, t->count)];
    const double angle = sim_uniform(seed, 0, 2 * SIM_PI), turn = sim_uniform(seed, -0.5, 0.5);
    const double near = sim_uniform(seed, 0.1, 0.5), far = sim_uniform(seed, 0.1, 1.5);
    const double x = sim_x(t->world, on) + near * cos(angle);
    const double y = sim_y(t->world, on) + near * sin(angle);
    const double bx = x + far * cos(angle + turn), by = y + far * sin(angle + turn);
    add_body(t, seed, bx, by);
    plumb_joint_desc d = { .kind = kind,
                           .body_a = on,
                           .body_b = t->body[t->count - 1],
                           .anchor = sim_vec(x, y),
                           .hertz = 4,
                           .damping = (plumb_real)damping };
    if (kind == PLUMB_WHEEL || kind == PLUMB_PRISMATIC) {
        d.axis = sim_vec(cos(angle), sin(angle));
    } else if (kind == PLUMB_DISTANCE) {
        d.anchor_b = sim_vec(bx + sim_uniform(seed, -0.3, 0.3), by + sim_uniform(seed, -0.3, 0.3));
    }
    sim_joint(t->world, d);
}

static double energy(const plumb_world *w)
{
    const plumb_energy e = plumb_world_energy(w);
    return e.kinetic + e.stored;
}

// The most by which energy grows in 10 s above the least it had been.
static double energy_made(plumb_joint_kind kind, double damping, uint32_t seed)
{
    tumble t = { .world =
                     sim_world(&(plumb_world_desc){ .zero_gravity = true, .no_sleep = true }) };
    add_body(&t, &seed, 0, 0);
    const int bodies = 2 + (int)sim_uniform(&seed, 0, 10);
    while (t.count < bodies) {
        hang_body(&t, &seed, kind, damping);
    }
    double least = energy(t.world), most = 0;
    for (int i = 0; i < 600; ++i) {
        sim_step(t.world, DT);
        least = fmin(least, energy(t.world));
        most = fmax(most, energy(t.world) / least - 1);
    }
    plumb_world_destroy(t.world);
    return most;
}

// The mass that a spring meets changes with the pose of its bodies: a stiffness that followed it was a swing that is pumped.
static void springs_in_hertz_make_no_energy(void **state)
{
    (void)state;
    const plumb_joint_kind kinds[] = { PLUMB_DISTANCE,  PLUMB_WHEEL, PLUMB_MOTOR,
                                       PLUMB_PRISMATIC, PLUMB_WELD,  PLUMB_REVOLUTE };
    const double dampings[] = { 0, 0.1, 0.5, 1 };
    for (size_t i = 0; i < 24; ++i) {
        double worst = 0;
        const trials t = trials_from(1, 5);
        for (uint32_t seed = t.first; seed < t.end; ++seed) {
            worst = fmax(worst, energy_made(kinds[i / 4], dampings[i % 4], 7919 * seed));
        }
        print_message("%s, damping %g: energy grows by %.2g at most\n",
                      plumb_joint_kind_name(kinds[i / 4]), dampings[i % 4], worst);
        assert_true(worst < 0.01);
    }
}

// What a spring between the ends of two rods does in 3 s, and that of the same stiffness told in newtons.
static void hertz_are_those_of_the_joint_as_made(void **state)
{
    (void)state;
    const double kg[2] = { 2, 0.5 }, length = 1, hertz = 2, damping = 0.1, w2 = 4 * SIM_PI * SIM_PI;
    // Rods lie along x, the spring along y: a rod's end meets a quarter of its mass.
    const double met = 1 / (4 / kg[0] + 4 / kg[1]);
    plumb_vec2 end[2];
    for (int newtons = 0; newtons < 2; ++newtons) {
        plumb_world *w = sim_world(&(plumb_world_desc){ .zero_gravity = true, .no_sleep = true });
        plumb_body rod[2];
        for (int i = 0; i < 2; ++i) {
            rod[i] = sim_mass(w, 0, i, kg[i], kg[i] * length * length / 12);
        }
        sim_launch(w, rod[0], 0, -1, 3);
        plumb_joint_desc d = { .kind = PLUMB_DISTANCE,
                               .body_a = rod[0],
                               .body_b = rod[1],
                               .anchor = sim_vec(length / 2, 0),
                               .anchor_b = sim_vec(length / 2, 1) };
        if (newtons != 0) {
            d.stiffness = (plumb_real)(w2 * hertz * hertz * met);
            d.damper = (plumb_real)(2 * damping * sqrt(w2) * hertz * met);
        } else {
            d.hertz = (plumb_real)hertz, d.damping = (plumb_real)damping;
        }
        sim_joint(w, d);
        sim_run(w, 180, DT);
        end[newtons] = plumb_body_position(w, rod[1]);
        plumb_world_destroy(w);
    }
    print_message("told in hertz (%.6f, %.6f), in newtons (%.6f, %.6f)\n", (double)end[0].x,
                  (double)end[0].y, (double)end[1].x, (double)end[1].y);
    assert_near((double)end[0].x, (double)end[1].x, SIM_TOLERANCE(2e-5, 1e-9));
    assert_near((double)end[0].y, (double)end[1].y, SIM_TOLERANCE(2e-5, 1e-9));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(dampers_brake_by_their_exponential),
        cmocka_unit_test(stiffness_stays_when_the_mass_changes),
        cmocka_unit_test(springs_in_newtons_turn_what_they_hold),
        cmocka_unit_test(loads_stretch_springs_in_newtons),
        cmocka_unit_test(springs_in_hertz_make_no_energy),
        cmocka_unit_test(hertz_are_those_of_the_joint_as_made),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
