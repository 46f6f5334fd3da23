// test_orbits.c - laws against closed forms: the order of what flies and of what is pushed, orbits that return, energies that
// stay, circles and drifts of charges, what a body does that comes into a contact.
#include "harness/near.h"
#include "plumb/plumb.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#define R(x) ((plumb_real)(x))
#define TAU  6.283185307179586

// What rounding to places and velocities of plumb_real leaves.
#define NOISE (sizeof(plumb_real) == 8 ? 1e-10 : 3e-5)

static plumb_world *make_world(plumb_world_desc desc)
{
    plumb_world *w;
    desc.zero_gravity = true;
    assert_int_equal(plumb_world_create(&desc, &w), PLUMB_OK);
    return w;
}

static void go(plumb_world *w, double time, double dt)
{
    const int steps = (int)(time / dt + 0.5);
    for (int i = 0; i < steps; ++i) {
        assert_int_equal(plumb_world_step(w, R(time / steps)), PLUMB_OK);
    }
}

static double apart(plumb_vec2 a, double x, double y)
{
    const double dx = (double)a.x - x, dy = (double)a.y - y;
    return sqrt(dx * dx + dy * dy);
}

// A planet at its farther apsis, about a sun with G m = 1; a = 1.
static plumb_body make_planet(plumb_world *w, double e, plumb_body_desc desc)
{
    plumb_law_create(w, &(plumb_law_desc){ .kind = PLUMB_LAW_ATTRACTOR, .strength = 1 });
    desc.position = (plumb_vec2){ R(1 + e), 0 };
    desc.velocity = (plumb_vec2){ 0, R(sqrt((1 - e) / (1 + e))) };
    desc.no_sleep = true;
    return plumb_body_create(w, &desc);
}

typedef struct run {
    plumb_orbit_desc orbits;
    plumb_solver solver;
    double e, turns, dt;
    int substeps;
    bool pushed; // by the solver, in the substeps
} run;

// Kepler's equation M = u - e sin u, from the farther apsis on.
static void place_at(double e, double time, double out[2])
{
    const double mean = time + TAU / 2;
    double u = mean;
    for (int i = 0; i < 60; ++i) {
        u -= (u - e * sin(u) - mean) / (1 - e * cos(u));
    }
    out[0] = e - cos(u);
    out[1] = -sqrt(1 - e * e) * sin(u);
}

// [m] off the ellipse's place.
static double kepler(run r)
{
    plumb_world *w = make_world((plumb_world_desc){ .substeps = r.substeps, .solver = r.solver });
    plumb_world_set_orbits(w, &r.orbits);
    const plumb_body planet =
        make_planet(w, r.e, (plumb_body_desc){ .damping = r.pushed ? R(1e-30) : 0 });
    go(w, r.turns * TAU, r.dt);
    double at[2];
    place_at(r.e, r.turns * TAU, at);
    const double off = apart(plumb_body_center(w, planet), at[0], at[1]);
    plumb_world_destroy(w);
    return off;
}

// [m] off the place of a body on a spring about the origin, after three turns and a half.
static double spring(run r)
{
    const double time = 3.5 * TAU;
    plumb_world *w = make_world((plumb_world_desc){ .substeps = r.substeps });
    plumb_law_create(w, &(plumb_law_desc){ .kind = PLUMB_LAW_ATTRACTOR,
                                           .strength = 1,
                                           .falloff = PLUMB_FALLOFF_SPRING });
    plumb_world_set_orbits(w, &r.orbits);
    const plumb_body body = plumb_body_create(
        w, &(plumb_body_desc){ .position = { 1, 0 }, .velocity = { 0, R(0.5) }, .no_sleep = true });
    go(w, time, r.dt);
    const double off = apart(plumb_body_center(w, body), cos(time), 0.5 * sin(time));
    plumb_world_destroy(w);
    return off;
}

//---- order ---------------------------------------------------------------------------------------

// Halving the step divides the error by 2^order.
static void assert_order(run r, double (*error)(run r), double order)
{
    double last = error(r);
    for (int i = 0; i < 3; ++i) {
        r.dt /= 2;
        const double off = error(r), fell = log(last / off) / log(2);
        print_message("dt %.3g: off by %.3g m, order %.2f\n", r.dt, off, fell);
        if (i > 0) {
            assert_true(fabs(fell - order) < 0.25);
        }
        last = off;
    }
}

static void velocity_verlet_is_of_second_order(void **state)
{
    (void)state;
    assert_order((run){ .e = 0.5, .turns = 1, .dt = 0.1, .substeps = 1 }, kepler, 2);
}

static void what_is_pushed_is_of_second_order(void **state)
{
    (void)state;
    assert_order((run){ .e = 0.5, .turns = 1, .dt = 0.1, .substeps = 1, .pushed = true }, kepler,
                 2);
    assert_order((run){ .e = 0.5,
                        .turns = 1,
                        .dt = 0.1,
                        .substeps = 1,
                        .pushed = true,
                        .solver = PLUMB_SOLVER_PGS },
                 kepler, 2);
}

// On a spring: about a sun the errors of fourth order are so small that those of sixth are seen, until rounding is.
static void blanes_and_moan_is_of_fourth_order(void **state)
{
    (void)state;
    if (sizeof(plumb_real) == 8) { // floats do not hold what it leaves
        assert_order((run){ .orbits = { .order = 4 }, .dt = 0.4, .substeps = 1 }, spring, 4);
        assert_order((run){ .orbits = { .order = 4 }, .dt = 0.8, .substeps = 3 }, spring, 4);
    }
}

//---- orbits --------------------------------------------------------------------------------------

static void orbits_return(void **state)
{
    (void)state;
    const run fourth = {
        .orbits = { .order = 4 }, .e = 0.5, .turns = 5, .dt = 1.0 / 60, .substeps = 4
    };
    assert_true(kepler(fourth) < NOISE);
    run steep = fourth;
    steep.e = 0.9;
    assert_true(kepler(steep) < 1e-7 + 10 * NOISE);
    steep.orbits = (plumb_orbit_desc){ .tolerance = R(1e-12) };
    steep.substeps = 1;
    assert_true(kepler(steep) < 1e-8 + 10 * NOISE);
    steep.orbits.tolerance = 0;
    assert_true(kepler(steep) > 1e-2); // what the others are for
}

// The error of the energy is as large after a thousand turns as after ten.
static void energies_stay_bounded(void **state)
{
    (void)state;
    for (int order = 2; order <= 4; order += 2) {
        plumb_world *w = make_world((plumb_world_desc){ .substeps = 1 });
        plumb_world_set_orbits(w, &(plumb_orbit_desc){ .order = order });
        make_planet(w, 0.3, (plumb_body_desc){ .mass = 3 });
        const double before = plumb_world_energy(w).kinetic + plumb_world_energy(w).potential;
        assert_true(fabs(before + 1.5) < 1e-5);
        double worst[2] = { 0, 0 }; // of the first ten turns, of the last ten
        for (int step = 0; step < 1000 * 63; ++step) {
            assert_int_equal(plumb_world_step(w, R(TAU / 63)), PLUMB_OK);
            if (step < 10 * 63 || step >= 990 * 63) {
                const plumb_energy e = plumb_world_energy(w);
                const double off = fabs(e.kinetic + e.potential - before);
                worst[step >= 10 * 63] = fmax(worst[step >= 10 * 63], off);
            }
        }
        print_message("order %d: %.3g J, then %.3g J\n", order, worst[0], worst[1]);
        assert_true(worst[1] < 1.1 * worst[0] + 20 * NOISE);
        plumb_world_destroy(w);
    }
}

// Chenciner and Montgomery 2000: after a period of 6.32591398 s three bodies are where they were.
static void the_eight_returns(void **state)
{
    (void)state;
    const double x = 0.97000436, y = -0.24308753, u = -0.93240737, v = -0.86473146;
    const double at[3][4] = { { x, y, -u / 2, -v / 2 },
                              { -x, -y, -u / 2, -v / 2 },
                              { 0, 0, u, v } };
    plumb_world *w = make_world((plumb_world_desc){ 0 });
    plumb_law_create(w, &(plumb_law_desc){ .kind = PLUMB_LAW_MUTUAL, .strength = 1 });
    plumb_world_set_orbits(w, &(plumb_orbit_desc){ .order = 4 });
    plumb_body bodies[3];
    for (int i = 0; i < 3; ++i) {
        bodies[i] =
            plumb_body_create(w, &(plumb_body_desc){ .position = { R(at[i][0]), R(at[i][1]) },
                                                     .velocity = { R(at[i][2]), R(at[i][3]) },
                                                     .attraction = 1 });
    }
    go(w, 6.32591398, 1.0 / 60);
    for (int i = 0; i < 3; ++i) {
        assert_true(apart(plumb_body_center(w, bodies[i]), at[i][0], at[i][1]) < 1e-6 + NOISE);
    }
    plumb_world_destroy(w);
}

// Two stars about their centre of mass, one of which carries the attractor: period 2 pi sqrt(d^3 / G (m + M)).
static void a_carried_attractor_has_a_reaction(void **state)
{
    (void)state;
    const double m = 1, big = 3, d = 2, speed = sqrt((m + big) / d);
    plumb_world *w = make_world((plumb_world_desc){ 0 });
    plumb_world_set_orbits(w, &(plumb_orbit_desc){ .order = 4 });
    const plumb_body star = plumb_body_create(
        w, &(plumb_body_desc){ .mass = R(big), .velocity = { 0, R(-speed * m / (m + big)) } });
    const plumb_body other =
        plumb_body_create(w, &(plumb_body_desc){ .mass = R(m),
                                                 .position = { R(d), 0 },
                                                 .velocity = { 0, R(speed * big / (m + big)) } });
    plumb_law_create(
        w, &(plumb_law_desc){ .kind = PLUMB_LAW_ATTRACTOR, .body = star, .strength = R(big) });
    // The pull is G M a kilogram of the other: the star feels m of it, as from a mass m.
    go(w, 3 * TAU * sqrt(d * d * d / (m + big)), 1.0 / 60);
    assert_true(apart(plumb_body_center(w, star), 0, 0) < 10 * NOISE);
    assert_true(apart(plumb_body_center(w, other), d, 0) < 10 * NOISE);
    plumb_world_destroy(w);
}

//---- charges -------------------------------------------------------------------------------------

// [m] off a cycloid after 10 s: w = q B / m, k = q E / m.
static double cycloid(double dt, bool pushed)
{
    const double w0 = 6, k = 3, t = 10;
    plumb_world *w = make_world((plumb_world_desc){ 0 });
    plumb_law_create(w, &(plumb_law_desc){ .kind = PLUMB_LAW_MAGNETIC, .strength = R(w0) });
    plumb_law_create(w, &(plumb_law_desc){ .hold = PLUMB_LAW_ON_CHARGE, .vector = { 0, R(k) } });
    const plumb_body b = plumb_body_create(
        w, &(plumb_body_desc){ .mass = 2, .charge = 2, .damping = pushed ? R(1e-30) : 0 });
    go(w, t, dt);
    const double off = apart(plumb_body_center(w, b), k / w0 * (t - sin(w0 * t) / w0),
                             k / (w0 * w0) * (1 - cos(w0 * t)));
    plumb_world_destroy(w);
    return off;
}

static void charges_drift_across_fields(void **state)
{
    (void)state;
    assert_true(cycloid(0.5, false) < NOISE); // exactly, however long the step
    assert_true(cycloid(1.0 / 60, false) < NOISE);
    const double coarse = cycloid(1.0 / 30, true), fine = cycloid(1.0 / 60, true);
    assert_true(fine < 0.01 && fabs(log(coarse / fine) / log(2) - 2) < 0.2);
}

// The circle's radius is m v / (q B), the speed stays, however it is moved.
static void circles_have_larmors_radius(void **state)
{
    (void)state;
    for (int pushed = 0; pushed < 2; ++pushed) {
        const double noise = pushed ? 3e-4 : 10 * NOISE; // the solver may have floats
        plumb_world *w = make_world((plumb_world_desc){ 0 });
        plumb_law_create(w, &(plumb_law_desc){ .kind = PLUMB_LAW_MAGNETIC, .strength = 4 });
        const plumb_body b = plumb_body_create(
            w, &(plumb_body_desc){
                   .velocity = { 2, 0 }, .charge = 1, .damping = pushed ? R(1e-30) : 0 });
        for (int i = 0; i < 600; ++i) {
            plumb_world_step(w, R(1.0 / 60));
            const plumb_vec2 v = plumb_body_velocity(w, b);
            assert_true(fabs(apart(plumb_body_center(w, b), 0, -0.5) - 0.5) < noise);
            assert_true(fabs(apart(v, 0, 0) - 2) < noise);
        }
        plumb_world_destroy(w);
    }
}

//---- contacts ------------------------------------------------------------------------------------

// A ball falls through a hole in a spring's pull, bounces off a wall at e = 1, and is back: flies, is pushed, flies.
static void who_meets_a_wall_flies_on(void **state)
{
    (void)state;
    plumb_world *w = make_world((plumb_world_desc){ 0 });
    plumb_world_set_orbits(w, &(plumb_orbit_desc){ .order = 4 });
    const plumb_material hard =
        plumb_material_create(w, &(plumb_material_desc){ .restitution = 1, .frictionless = true });
    plumb_law_create(w, &(plumb_law_desc){ .kind = PLUMB_LAW_ATTRACTOR,
                                           .falloff = PLUMB_FALLOFF_SPRING,
                                           .strength = 4 });
    const plumb_body wall = plumb_body_create(w, &(plumb_body_desc){ .type = PLUMB_STATIC });
    plumb_shape_create(w, wall,
                       &(plumb_shape_desc){ .kind = PLUMB_BOX,
                                            .half = { R(0.5), 2 },
                                            .center = { R(-0.75), 0 },
                                            .material = hard });
    const plumb_body ball =
        plumb_body_create(w, &(plumb_body_desc){ .position = { 1, 0 }, .no_sleep = true });
    plumb_shape_create(
        w, ball, &(plumb_shape_desc){ .kind = PLUMB_CIRCLE, .radius = R(0.25), .material = hard });
    go(w, TAU / 2, 1.0 / 240); // from 1 to 0 and back in pi / 2, twice
    assert_true(apart(plumb_body_center(w, ball), 1, 0) < 0.01);
    const plumb_energy e = plumb_world_energy(w);
    assert_true(fabs((e.kinetic + e.potential) / e.mass - 2) < 0.02);
    plumb_world_destroy(w);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(velocity_verlet_is_of_second_order),
        cmocka_unit_test(what_is_pushed_is_of_second_order),
        cmocka_unit_test(blanes_and_moan_is_of_fourth_order),
        cmocka_unit_test(orbits_return),
        cmocka_unit_test(energies_stay_bounded),
        cmocka_unit_test(the_eight_returns),
        cmocka_unit_test(a_carried_attractor_has_a_reaction),
        cmocka_unit_test(charges_drift_across_fields),
        cmocka_unit_test(circles_have_larmors_radius),
        cmocka_unit_test(who_meets_a_wall_flies_on),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
