// test_formula_motion.c - laws that are formulas against closed forms: wells, pendulums, fields that turn, drag, frames of
// reference; with the order of each way to move: what flies at order 2 and 4 and to a tolerance, what is pushed.
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
    desc.zero_gravity = desc.gravity.x == 0 && desc.gravity.y == 0;
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

static plumb_law add(plumb_world *w, plumb_law_desc d)
{
    d.kind = PLUMB_LAW_FORMULA;
    const plumb_law law = plumb_law_create(w, &d);
    if (plumb_is_null(law)) {
        print_error("%s\n", plumb_world_error(w).message);
        fail();
    }
    return law;
}

//---- a run, and where it ought to end ------------------------------------------------------------

typedef enum way { FLIES, FLIES_AT_FOURTH, PUSHED, PUSHED_CLASSIC, WAYS } way;

typedef struct motion {
    double x, y, vx, vy;
} motion;

// One body among laws; `end` says where it is then.
typedef struct question {
    plumb_law_desc laws[2];
    plumb_vec2 gravity;
    motion start;
    double time, dt, charge;
    double spin; // [rad/s] of a kinematic body that carries the first law; 0: nobody
    motion (*end)(double time);
} question;

static double miss(const question *q, way how, double dt, double tolerance)
{
    plumb_world *w = make_world((plumb_world_desc){
        .substeps = 1,
        .gravity = q->gravity,
        .solver = how == PUSHED_CLASSIC ? PLUMB_SOLVER_PGS : PLUMB_SOLVER_SOFT });
    plumb_world_set_orbits(w, &(plumb_orbit_desc){ .order = how == FLIES_AT_FOURTH ? 4 : 2,
                                                   .tolerance = R(tolerance) });
    plumb_law_desc first = q->laws[0];
    if (q->spin != 0) {
        first.body = plumb_body_create(
            w, &(plumb_body_desc){ .type = PLUMB_KINEMATIC, .angular_velocity = R(q->spin) });
    }
    if (first.kind == PLUMB_LAW_FORMULA) {
        add(w, first);
    }
    if (q->laws[1].kind != PLUMB_LAW_UNIFORM) {
        assert_false(plumb_is_null(plumb_law_create(w, &q->laws[1])));
    }
    const plumb_body b =
        plumb_body_create(w, &(plumb_body_desc){ .position = { R(q->start.x), R(q->start.y) },
                                                 .velocity = { R(q->start.vx), R(q->start.vy) },
                                                 .mass = 2,
                                                 .charge = R(q->charge),
                                                 .damping = how >= PUSHED ? R(1e-30) : 0,
                                                 .no_sleep = true });
    go(w, q->time, dt);
    const plumb_vec2 at = plumb_body_center(w, b), v = plumb_body_velocity(w, b);
    const motion end = q->end(q->time);
    const double off = hypot(hypot((double)at.x - end.x, (double)at.y - end.y),
                             hypot((double)v.x - end.vx, (double)v.y - end.vy));
    plumb_world_destroy(w);
    return off;
}

// Halving the step divides the error by 2^order, until rounding is reached.
static void assert_orders(const char *name, const question *q)
{
    static const char *const names[] = { "flies", "at order 4", "pushed", "pushed, classic" };
    for (int how = 0; how < WAYS; ++how) {
        const double order = how == FLIES_AT_FOURTH ? 4 : 2;
        double dt = q->dt, last = miss(q, (way)how, dt, 0);
        for (int i = 0; i < 3; ++i) {
            dt /= 2;
            const double off = miss(q, (way)how, dt, 0), fell = log(last / off) / log(2);
            print_message("%s, %s, dt %.3g: off by %.3g, order %.2f\n", name, names[how], dt, off,
                          fell);
            const double noise = how >= PUSHED && sizeof(plumb_near) == 4 ? 2e-3 : 30 * NOISE;
            if (i > 0 && off > noise) {
                assert_true(fabs(fell - order) < 0.35 || fell > order);
            }
            last = off;
        }
    }
}

static void assert_held_to_tolerance(const question *q)
{
    assert_true(miss(q, FLIES, q->dt, 1e-9) < 1e-6 + 30 * NOISE);
    assert_true(miss(q, FLIES, q->dt, 1e-14) < 1e-9 + 30 * NOISE);
}

// By many small steps of Runge and Kutta, in double.
static motion by_steps(motion s, double time, void (*pull)(motion s, double t, double a[2]))
{
    const int n = 40000;
    const double h = time / n;
    for (int i = 0; i < n; ++i) {
        static const double ahead[] = { 0, 0.5, 0.5, 1 }, weight[] = { 1, 2, 2, 1 };
        motion sum = s, k = { 0 };
        for (int j = 0; j < 4; ++j) {
            const double g = h * ahead[j];
            const motion at = { s.x + g * k.x, s.y + g * k.y, s.vx + g * k.vx, s.vy + g * k.vy };
            double a[2];
            pull(at, h * i + g, a);
            k = (motion){ at.vx, at.vy, a[0], a[1] };
            sum.x += h / 6 * weight[j] * k.x, sum.y += h / 6 * weight[j] * k.y;
            sum.vx += h / 6 * weight[j] * k.vx, sum.vy += h / 6 * weight[j] * k.vy;
        }
        s = sum;
    }
    return s;
}

//---- places --------------------------------------------------------------------------------------

static motion in_a_well(double t)
{
    return (motion){ 1 + cos(2 * t), 0.5 * sin(2 * t), -2 * sin(2 * t), cos(2 * t) };
}

// U = 2 ((x - 1)^2 + y^2) by its slope, and the same by components.
static void a_harmonic_well_is_exact(void **state)
{
    (void)state;
    question q = { .laws = { { .kind = PLUMB_LAW_FORMULA,
                               .position = { 1, 0 },
                               .potential = "0.5 * 4 * (x^2 + y^2)" } },
                   .start = { 2, 0, 0, 1 },
                   .time = 3.5 * TAU / 2,
                   .dt = 0.2,
                   .end = in_a_well };
    assert_orders("well", &q);
    assert_held_to_tolerance(&q);
    q.laws[0].potential = NULL;
    q.laws[0].formula_x = "-4 * x";
    q.laws[0].formula_y = "-4 * y";
    assert_orders("spring", &q);
    // Along axes that are turned it is the same.
    q.laws[0].angle = R(0.7);
    assert_true(miss(&q, FLIES_AT_FOURTH, 0.01, 0) < 1e-7 + 30 * NOISE);
}

static void in_a_tilted_well(motion s, double t, double a[2])
{
    const double c = cos(0.7), n = sin(0.7), x = c * s.x + n * s.y, y = c * s.y - n * s.x;
    (void)t;
    a[0] = -9 * x * c + y * n, a[1] = -9 * x * n - y * c;
}

static motion tilted_end(double t)
{
    return by_steps((motion){ 1, 0.5, 0, 0 }, t, in_a_tilted_well);
}

static void axes_are_turned_by_the_angle(void **state)
{
    (void)state;
    const question q = { .laws = { { .kind = PLUMB_LAW_FORMULA,
                                     .angle = R(0.7),
                                     .potential = "4.5 * x^2 + 0.5 * y^2" } },
                         .start = { 1, 0.5, 0, 0 },
                         .time = 5,
                         .dt = 0.1,
                         .end = tilted_end };
    assert_orders("turned axes", &q);
}

// U = x^4 / 4 from rest at A: the period is 7.41629870920549 / A (4 sqrt(2) times the lemniscate's 1.31102877714606).
static void a_quartic_well_has_its_period(void **state)
{
    (void)state;
    const double period = 7.4162987092054876 / 1.5;
    for (int order = 2; order <= 4; order += 2) {
        plumb_world *w = make_world((plumb_world_desc){ 0 });
        plumb_world_set_orbits(w, &(plumb_orbit_desc){ .order = order });
        add(w, (plumb_law_desc){ .potential = "x^4 / 4" });
        const plumb_body b = plumb_body_create(
            w, &(plumb_body_desc){ .position = { R(1.5), 0 }, .mass = 1, .no_sleep = true });
        const plumb_energy before = plumb_world_energy(w);
        assert_near(before.potential, 1.5 * 1.5 * 1.5 * 1.5 / 4, 1e-6);
        double worst = 0;
        for (int i = 0; i < 3 * 300; ++i) {
            plumb_world_step(w, R(period / 300));
            const plumb_energy e = plumb_world_energy(w);
            worst = fmax(worst, fabs(e.kinetic + e.potential - before.potential));
        }
        print_message("order %d: energy off by %.2g J at the most, place by %.2g m\n", order, worst,
                      fabs((double)plumb_body_center(w, b).x - 1.5));
        assert_true(worst < (order == 2 ? 1e-4 : 1e-9 + 20 * NOISE));
        assert_near(plumb_body_center(w, b).x, 1.5, (order == 2 ? 1e-5 : 1e-9 + 10 * NOISE));
        plumb_world_destroy(w);
    }
}

// U = -9 cos(x), a pendulum of amplitude 2 rad: its period is 4 K(sin 1) / 3.
static void a_pendulum_has_its_period(void **state)
{
    (void)state;
    double a = 1, g = cos(1.0); // K by the arithmetic-geometric mean
    for (int i = 0; i < 8; ++i) {
        const double mean = (a + g) / 2;
        g = sqrt(a * g);
        a = mean;
    }
    const double period = 4 * (TAU / 4 / a) / 3;
    plumb_world *w = make_world((plumb_world_desc){ 0 });
    plumb_world_set_orbits(w, &(plumb_orbit_desc){ .order = 4 });
    add(w, (plumb_law_desc){ .potential = "-9 * cos(x)" });
    const plumb_body b =
        plumb_body_create(w, &(plumb_body_desc){ .position = { 2, 0 }, .no_sleep = true });
    go(w, 2 * period, period / 200);
    assert_near(plumb_body_center(w, b).x, 2, 1e-9 + 10 * NOISE);
    assert_near(plumb_body_velocity(w, b).x, 0, 1e-7 + 30 * NOISE);
    go(w, period / 2, period / 200);
    assert_near(plumb_body_center(w, b).x, -2, 1e-9 + 30 * NOISE);
    plumb_world_destroy(w);
}

// Of a formula that says what an attractor is.
static void a_formula_is_an_attractor(void **state)
{
    (void)state;
    for (int how = 0; how < WAYS; ++how) {
        plumb_vec2 at[2], v[2];
        for (int k = 0; k < 2; ++k) {
            plumb_world *w = make_world((plumb_world_desc){
                .solver = how == PUSHED_CLASSIC ? PLUMB_SOLVER_PGS : PLUMB_SOLVER_SOFT });
            plumb_world_set_orbits(w,
                                   &(plumb_orbit_desc){ .order = how == FLIES_AT_FOURTH ? 4 : 2 });
            if (k == 0) {
                plumb_law_create(w, &(plumb_law_desc){ .kind = PLUMB_LAW_ATTRACTOR,
                                                       .position = { 1, 2 },
                                                       .strength = 3 });
            } else {
                add(w, (plumb_law_desc){ .position = { 1, 2 },
                                         .formula_x = "-3 * x / r^3",
                                         .formula_y = "-3 * y / r^3" });
            }
            const plumb_body b =
                plumb_body_create(w, &(plumb_body_desc){ .position = { 3, 2 },
                                                         .velocity = { R(0.2), R(1.1) },
                                                         .damping = how >= PUSHED ? R(1e-30) : 0,
                                                         .no_sleep = true });
            go(w, 10, 1.0 / 60);
            at[k] = plumb_body_center(w, b), v[k] = plumb_body_velocity(w, b);
            plumb_world_destroy(w);
        }
        assert_near(at[0].x, at[1].x, how >= PUSHED ? ROUNDED(2e-3) : ROUNDED(1e-4));
        assert_near(at[0].y, at[1].y, how >= PUSHED ? ROUNDED(2e-3) : ROUNDED(1e-4));
        assert_near(v[0].x, v[1].x, how >= PUSHED ? ROUNDED(2e-3) : ROUNDED(1e-4));
    }
}

//---- time ----------------------------------------------------------------------------------------

// a = (cos t, sin t): v = (sin t, 1 - cos t).
static motion in_a_turning_field(double t)
{
    return (motion){ 1 - cos(t), t - sin(t), sin(t), 1 - cos(t) };
}

static void a_field_that_turns_is_followed(void **state)
{
    (void)state;
    const question q = {
        .laws = { { .kind = PLUMB_LAW_FORMULA, .formula_x = "cos(t)", .formula_y = "sin(t)" } },
        .time = 9,
        .dt = 0.25,
        .end = in_a_turning_field
    };
    assert_orders("turning field", &q);
    assert_held_to_tolerance(&q);
}

// It begins at the world's own time, and begins again where that is set.
static void time_is_that_of_the_world(void **state)
{
    (void)state;
    plumb_world *w = make_world((plumb_world_desc){ 0 });
    plumb_world_set_orbits(w, &(plumb_orbit_desc){ .order = 4 });
    add(w, (plumb_law_desc){ .formula_x = "step(t - 100)" });
    const plumb_body b = plumb_body_create(w, &(plumb_body_desc){ .no_sleep = true });
    go(w, 1, 1.0 / 64);
    assert_near(plumb_body_velocity(w, b).x, 0, 0);
    plumb_world_set_time(w, 99.5);
    go(w, 1, 1.0 / 64);
    assert_near(plumb_body_velocity(w, b).x, 0.5, 0.01);
    plumb_world_destroy(w);
}

//---- velocities ----------------------------------------------------------------------------------

// v' = -k v^2 along x.
static motion braked(double t)
{
    const double k = 0.4, v = 5, f = 1 + k * v * t;
    return (motion){ log(f) / k, 0, v / f, 0 };
}

// v' = -g + k v^2, from rest, downwards: v = u tanh(g t / u), y = u^2 / g ln cosh(g t / u), u^2 = g / k.
static motion falls_in_air(double t)
{
    const double g = 10, k = 0.4, u = sqrt(g / k);
    return (motion){ 0, -u * u / g * log(cosh(g * t / u)), 0, -u * tanh(g * t / u) };
}

static void quadratic_drag_follows_its_closed_form(void **state)
{
    (void)state;
    question q = { .laws = { { .kind = PLUMB_LAW_FORMULA,
                               .formula_x = "-0.4 * vx * hypot(vx, vy)",
                               .formula_y = "-0.4 * vy * hypot(vx, vy)" } },
                   .start = { 0, 0, 5, 0 },
                   .time = 3,
                   .dt = 0.1,
                   .end = braked };
    assert_orders("braked", &q);
    assert_held_to_tolerance(&q);
    q.gravity = (plumb_vec2){ 0, -10 };
    q.start = (motion){ 0 };
    q.end = falls_in_air;
    assert_orders("falls in air", &q);
    assert_held_to_tolerance(&q);
}

// Turned by a velocity, as by the Earth: a circle of radius v / w, and no work is done.
static motion on_a_circle(double t)
{
    return (motion){ 2.0 / 3 * sin(3 * t), 2.0 / 3 * (cos(3 * t) - 1), 2 * cos(3 * t),
                     -2 * sin(3 * t) };
}

static void a_turn_by_formula_does_no_work(void **state)
{
    (void)state;
    const question q = {
        .laws = { { .kind = PLUMB_LAW_FORMULA, .formula_x = "3 * vy", .formula_y = "-3 * vx" } },
        .start = { 0, 0, 2, 0 },
        .time = 4,
        .dt = 0.1,
        .end = on_a_circle
    };
    assert_orders("circle", &q);
    for (int how = 0; how < 2; ++how) {
        plumb_world *w = make_world((plumb_world_desc){ .substeps = 1 });
        add(w, q.laws[0]);
        const plumb_body b = plumb_body_create(
            w, &(plumb_body_desc){
                   .velocity = { 2, 0 }, .damping = how == 0 ? 0 : R(1e-30), .no_sleep = true });
        go(w, 200, 0.1);
        const plumb_vec2 v = plumb_body_velocity(w, b);
        assert_near(hypot((double)v.x, (double)v.y), 2, ROUNDED(2e-3));
        plumb_world_destroy(w);
    }
}

// Beside a magnetic law, a well and an own field: everything at a time.
static void all_at_once(motion s, double t, double a[2])
{
    a[0] = -2 * s.x - 0.3 * s.vx + 0.5 * cos(t) + 1.5 * s.vy;
    a[1] = -3 * s.y - 0.3 * s.vy * hypot(s.vx, s.vy) - 1.5 * s.vx - 1;
}

static motion all_at_once_end(double t)
{
    return by_steps((motion){ 1, 0, 0, 2 }, t, all_at_once);
}

static void all_that_a_formula_knows_goes_together(void **state)
{
    (void)state;
    const question q = { .laws = { { .kind = PLUMB_LAW_FORMULA,
                                     .formula_x = "-2 * x - 0.3 * vx + 0.5 * cos(t)",
                                     .formula_y = "-3 * y - 0.3 * vy * hypot(vx, vy)" },
                                   { .kind = PLUMB_LAW_MAGNETIC, .strength = R(1.5) } },
                         .gravity = { 0, -1 },
                         .start = { 1, 0, 0, 2 },
                         .charge = 2,
                         .time = 4,
                         .dt = 0.1,
                         .end = all_at_once_end };
    assert_orders("all", &q);
    assert_held_to_tolerance(&q);
}

// Drag that stops a body within a thousandth of a substep, or a millionth: it does not swing about the wind, and is soon as fast.
static void strong_drag_is_stable(void **state)
{
    (void)state;
    static const char *const along[] = { "1e5 * (3 - vx)", "1e8 * (3 - vx)" };
    static const char *const across[] = { "-1e5 * vy * abs(vy)", "-1e8 * vy" };
    for (int how = 0; how < 8; ++how) {
        plumb_world *w = make_world((plumb_world_desc){ .substeps = 1 });
        add(w, (plumb_law_desc){ .formula_x = along[how / 4], .formula_y = across[how / 4] });
        const plumb_body b =
            plumb_body_create(w, &(plumb_body_desc){ .velocity = { -50, 50 },
                                                     .damping = how % 4 == 1 ? R(1e-30) : 0,
                                                     .no_sleep = true });
        plumb_world_set_orbits(w, &(plumb_orbit_desc){ .order = how % 4 == 2 ? 4 : 2,
                                                       .tolerance = how % 4 == 3 ? R(1e-6) : 0 });
        const double over = how % 4 < 2 ? 1e-3 : 2; // of extrapolation
        for (int i = 0; i < 120; ++i) {
            assert_int_equal(plumb_world_step(w, R(1.0 / 60)), PLUMB_OK);
            const plumb_vec2 v = plumb_body_velocity(w, b);
            assert_true((double)v.x < 3 + over && (double)v.y > -over);
        }
        assert_near(plumb_body_velocity(w, b).x, 3, 1e-3);
        assert_near(plumb_body_velocity(w, b).y, 0, 1e-3);
        plumb_world_destroy(w);
    }
}

//---- who carries it ------------------------------------------------------------------------------

// A well that is narrow along one axis turns with a wheel; on it the air stands still.
static void on_a_wheel(motion s, double t, double a[2])
{
    const double c = cos(2 * t), n = sin(2 * t), x = c * s.x + n * s.y, y = c * s.y - n * s.x;
    const double ux = s.vx + 2 * s.y, uy = s.vy - 2 * s.x;
    const double fx = -30 * x - 0.5 * (c * ux + n * uy), fy = -8 * y - 0.5 * (c * uy - n * ux);
    a[0] = c * fx - n * fy, a[1] = n * fx + c * fy;
}

static motion wheel_end(double t)
{
    return by_steps((motion){ 1, 0.2, 0, 1 }, t, on_a_wheel);
}

static void a_wheel_turns_the_axes(void **state)
{
    (void)state;
    const question q = { .laws = { { .kind = PLUMB_LAW_FORMULA,
                                     .formula_x = "-30 * x - 0.5 * vx",
                                     .formula_y = "-8 * y - 0.5 * vy" } },
                         .start = { 1, 0.2, 0, 1 },
                         .spin = 2,
                         .time = 3,
                         .dt = 0.05,
                         .end = wheel_end };
    assert_orders("wheel", &q);
}

// Within a lift that goes up evenly all is as in one that stands.
static void a_lift_takes_its_field_along(void **state)
{
    (void)state;
    plumb_world *w = make_world((plumb_world_desc){ 0 });
    const plumb_body lift = plumb_body_create(
        w,
        &(plumb_body_desc){ .type = PLUMB_KINEMATIC, .velocity = { 0, 3 }, .position = { 5, 0 } });
    add(w, (plumb_law_desc){ .body = lift, .formula_x = "-4 * x", .formula_y = "-4 * y - vy" });
    const plumb_body b = plumb_body_create(
        w, &(plumb_body_desc){ .position = { 6, 0 }, .velocity = { 0, 3 }, .no_sleep = true });
    go(w, TAU / 2, TAU / 2 / 200);
    assert_near(plumb_body_center(w, b).x, 6, 1e-4);
    assert_near(plumb_body_center(w, b).y, 3 * TAU / 2, 1e-4);
    assert_near(plumb_body_velocity(w, b).y, 3, 1e-4);
    plumb_world_destroy(w);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_harmonic_well_is_exact),
        cmocka_unit_test(axes_are_turned_by_the_angle),
        cmocka_unit_test(a_quartic_well_has_its_period),
        cmocka_unit_test(a_pendulum_has_its_period),
        cmocka_unit_test(a_formula_is_an_attractor),
        cmocka_unit_test(a_field_that_turns_is_followed),
        cmocka_unit_test(time_is_that_of_the_world),
        cmocka_unit_test(quadratic_drag_follows_its_closed_form),
        cmocka_unit_test(a_turn_by_formula_does_no_work),
        cmocka_unit_test(all_that_a_formula_knows_goes_together),
        cmocka_unit_test(strong_drag_is_stable),
        cmocka_unit_test(a_wheel_turns_the_axes),
        cmocka_unit_test(a_lift_takes_its_field_along),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
