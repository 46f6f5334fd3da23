// test_friction.c - Coulomb friction against closed forms: a sliding block, inclines, rolling and
// slipping discs, oblique impacts. Formulas: textbook mechanics of rigid bodies; the grip condition
// of an oblique impact follows from the impulse law with I = m r^2 / 2.
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "harness/near.h"
#include "harness/sim.h"

#define HZ60 (1 / 60.0)

static double radians(double degrees)
{
    return degrees * SIM_PI / 180;
}

//---- a block on a level floor --------------------------------------------------------------------

typedef struct slide_case {
    const char *name;
    double speed, friction;
    bool disc; // a disc that may not turn
} slide_case;

// Distance and error of one run.
static double slide_error(const slide_case *c, double rate, double *distance)
{
    plumb_world *w = sim_world(&(plumb_world_desc){ 0 });
    plumb_material m = sim_material(w, c->friction, 0);
    sim_floor(w, m);
    plumb_body b =
        c->disc ? sim_ball(w, -10, 0.25, 0.25, m) : sim_crate(w, -10, 0.25, 0.5, 0.25, m);
    assert_int_equal(plumb_body_set_fixed_rotation(w, b, c->disc), PLUMB_OK);
    sim_run(w, (int)(rate / 4), 1 / rate); // comes to rest on the floor
    double from = sim_x(w, b);
    sim_launch(w, b, c->speed, 0, 0);
    double lasts = c->speed / (c->friction * SIM_G);
    sim_run(w, (int)(lasts * rate + rate / 2), 1 / rate);
    *distance = sim_x(w, b) - from;
    assert_near(sim_vx(w, b), 0, ROUNDED(1e-5));
    plumb_world_destroy(w);
    double expected = c->speed * c->speed / (2 * c->friction * SIM_G);
    return fabs(*distance / expected - 1);
}

// What rounding can do to the way: each half of a substep rounds the speed by half a spacing, always to the
// same side at worst, which passes for that much more or less friction.
static double slide_rounding(const slide_case *c, double rate)
{
    double loss = c->friction * SIM_G / (rate * 4); // [m/s] a substep
    return SIM_EPSILON * c->speed / loss;
}

static void block_slides_its_distance(void **state)
{
    (void)state;
    const slide_case cases[] = { { "crate", 10, 0.4, false },
                                 { "crate, slippery", 6, 0.15, false },
                                 { "disc, not turning", 10, 0.4, true } };
    const double rates[] = { 60, 120, 240, 480, 960 };
    for (size_t k = 0; k < sizeof cases / sizeof cases[0]; ++k) {
        const slide_case *c = &cases[k];
        double error[5];
        for (int i = 0; i < 5; ++i) {
            double distance;
            error[i] = slide_error(c, rates[i], &distance);
            double bound = 1.1 * error[0] / (1 << i) + slide_rounding(c, rates[i]);
            print_message("slide, %-18s %4.0f Hz: %.5f m, error %.2g, bound %.2g\n", c->name,
                          rates[i], distance, error[i], bound);
            // First order: halving the step halves the error, until rounding is all that is left.
            assert_true(error[i] <= bound);
        }
        print_message("slide, %-18s order %.2f\n", c->name, sim_order(error, 5));
        assert_true(error[0] <= 0.01);
        assert_true(SIM_TOLERANCE(1.0, sim_order(error, 5)) >= 0.95);
    }
}

//---- inclines ------------------------------------------------------------------------------------

// A ramp through the origin that rises to the left; its surface passes through the origin.
static void add_ramp(plumb_world *w, double angle, plumb_material m)
{
    plumb_body ramp = sim_body(w, PLUMB_STATIC, -sin(angle), -cos(angle), -angle);
    sim_add_box(w, ramp, 200, 1, m);
}

// A body that lies on the ramp at the origin, its centre `height` above it.
static plumb_body on_ramp(plumb_world *w, double angle, double height)
{
    return sim_body(w, PLUMB_DYNAMIC, height * sin(angle), height * cos(angle), -angle);
}

static double down_ramp(const plumb_world *w, plumb_body b, double angle)
{
    return sim_x(w, b) * cos(angle) - sim_y(w, b) * sin(angle);
}

// How far a block creeps down a slope in 30 s, after one in which it settles by `from`.
static double creep_of(double degrees, double reserve, bool turns, double *from)
{
    double angle = radians(degrees);
    plumb_world *w = sim_world(&(plumb_world_desc){ .no_sleep = true }); // sleep would hide creep
    plumb_material m = sim_material(w, tan(angle) * reserve, 0);
    add_ramp(w, angle, m);
    plumb_body b = on_ramp(w, angle, 0.25);
    sim_add_box(w, b, 0.5, 0.25, m);
    assert_int_equal(plumb_body_set_fixed_rotation(w, b, !turns), PLUMB_OK);
    sim_run(w, 60, HZ60);
    *from = down_ramp(w, b, angle);
    sim_run(w, 30 * 60, HZ60);
    double creep = down_ramp(w, b, angle) - *from;
    plumb_world_destroy(w);
    return creep;
}

static void block_sticks_without_creep(void **state)
{
    (void)state;
    const double degrees[] = { 5, 15, 30, 40 };
    const double reserve[] = { 1.01, 1.2, 2 }; // mu over tan(theta)
    for (int i = 0; i < 4 * 3 * 2; ++i) {
        double slope = degrees[i / 6], spare = reserve[i / 2 % 3], from;
        bool turns = i % 2 == 0;
        double creep = creep_of(slope, spare, turns, &from);
        print_message("incline %2.0f degrees, mu = %.2f tan%s: settles by %.2g m, "
                      "creeps %.2g m in 30 s\n",
                      slope, spare, turns ? "" : ", cannot turn", from, creep);
        assert_near(from, 0, 2e-3);
        assert_near(creep, 0, ROUNDED(1e-4));
    }
}

static void block_slides_down(void **state)
{
    (void)state;
    const double degrees[] = { 5, 15, 30, 40 };
    const double share[] = { 0.98, 0.7, 0.3, 0 }; // mu over tan(theta)
    for (int i = 0; i < 4; ++i) {
        for (int k = 0; k < 4; ++k) {
            double angle = radians(degrees[i]);
            plumb_world *w = sim_world(&(plumb_world_desc){ 0 });
            double mu = tan(angle) * share[k];
            plumb_material m = sim_material(w, mu, 0);
            add_ramp(w, angle, m);
            plumb_body b = on_ramp(w, angle, 0.25);
            sim_add_box(w, b, 0.5, 0.25, m);
            double a = SIM_G * (sin(angle) - mu * cos(angle));
            sim_run(w, 60, HZ60);
            double x = down_ramp(w, b, angle);
            double v = hypot(sim_vx(w, b), sim_vy(w, b));
            sim_run(w, 120, HZ60);
            double dx = down_ramp(w, b, angle) - x;
            double dv = hypot(sim_vx(w, b), sim_vy(w, b)) - v;
            double error_v = fabs(dv / (2 * a) - 1);
            double error_x = fabs((dx - 2 * v) / (2 * a) - 1);
            print_message("incline %2.0f degrees, mu = %.2f tan: a %.4f, off by %.2g (speed), "
                          "%.2g (way); %.2g m/s ahead from the start\n",
                          degrees[i], share[k], a, error_v, error_x, v - a);
            assert_true(error_v <= 0.005 && error_x <= 0.005);
            // Friction may be late by one substep, no more, when the block is let go.
            assert_near(v, a, SIM_G * sin(angle) * HZ60 / 4 * 1.1);
            plumb_world_destroy(w);
        }
    }
}

// No slip: a = 2/3 g sin(theta), possible iff tan(theta) <= 3 mu. Else a = g (sin - mu cos) and the
// spin grows by 2 mu g cos(theta) / r.
static void disc_rolls_down(void **state)
{
    (void)state;
    const double degrees[] = { 5, 15, 30, 45 };
    const double share[] = { 6, 1.5, 1.02, 0.9, 0.5 }; // 3 mu over tan(theta)
    for (int i = 0; i < 4; ++i) {
        for (int k = 0; k < 5; ++k) {
            double angle = radians(degrees[i]), r = 0.4;
            double mu = tan(angle) * share[k] / 3;
            plumb_world *w = sim_world(&(plumb_world_desc){ 0 });
            plumb_material m = sim_material(w, mu, 0);
            add_ramp(w, angle, m);
            plumb_body b = on_ramp(w, angle, r);
            sim_add_circle(w, b, r, m);
            bool rolls = share[k] >= 1;
            double a =
                rolls ? 2.0 / 3 * SIM_G * sin(angle) : SIM_G * (sin(angle) - mu * cos(angle));
            double alpha = rolls ? a / r : 2 * mu * SIM_G * cos(angle) / r;
            sim_run(w, 30, HZ60);
            double v = hypot(sim_vx(w, b), sim_vy(w, b)), spin = sim_w(w, b);
            sim_run(w, 120, HZ60);
            double error_v = fabs((hypot(sim_vx(w, b), sim_vy(w, b)) - v) / (2 * a) - 1);
            double error_w = fabs((sim_w(w, b) - spin) / (-2 * alpha) - 1);
            print_message("disc %2.0f degrees, 3 mu = %.2f tan: a off by %.2g, spin by %.2g\n",
                          degrees[i], share[k], error_v, error_w);
            assert_true(error_v <= 0.005 && error_w <= 0.005);
            plumb_world_destroy(w);
        }
    }
}

//---- discs that slip -----------------------------------------------------------------------------

// Thrown without spin it rolls from t = v / (3 mu g) on, with 2/3 v, after d = 5 v^2 / (18 mu g).
static void sliding_disc_starts_to_roll(void **state)
{
    (void)state;
    const double v = 10, mu = 0.4, r = 0.5;
    const double rates[] = { 60, 120, 240, 480 };
    double error[4];
    for (int i = 0; i < 4; ++i) {
        plumb_world *w = sim_world(&(plumb_world_desc){ 0 });
        plumb_material m = sim_material(w, mu, 0);
        sim_floor(w, m);
        plumb_body b = sim_ball(w, -20, r, r, m);
        sim_run(w, 60, 1 / rates[i]);
        double from = sim_x(w, b);
        sim_launch(w, b, v, 0, 0);
        double rolls = 0;
        for (int k = 1; k <= (int)lround(1.5 * rates[i]); ++k) {
            sim_step(w, 1 / rates[i]);
            double slip = sim_vx(w, b) + sim_w(w, b) * r;
            if (rolls <= 0 && slip <= 1e-3 * v) {
                rolls = k / rates[i];
            }
        }
        double expected_t = v / (3 * mu * SIM_G);
        double way = 5 * v * v / (18 * mu * SIM_G) + 2.0 / 3 * v * (1.5 - expected_t);
        error[i] = fabs((sim_x(w, b) - from) / way - 1);
        double error_v = fabs(sim_vx(w, b) / (v * 2 / 3) - 1);
        double error_w = fabs(sim_w(w, b) * r / (-v * 2 / 3) - 1);
        print_message("rolling %3.0f Hz: from %.4f s (%.4f), speed off by %.2g, spin by %.2g, "
                      "way by %.2g\n",
                      rates[i], rolls, expected_t, error_v, error_w, error[i]);
        assert_near(rolls, expected_t, 2 / rates[i]);
        assert_true(error_v <= 0.005 && error_w <= 0.005);
        assert_true(error[i] <= 0.01);
        plumb_world_destroy(w);
    }
    print_message("rolling: order %.2f\n", sim_order(error, 4));
    for (int i = 1; i < 4; ++i) {
        assert_true(error[i] <= 1.1 * error[0] / (1 << i) + SIM_TOLERANCE(1e-4, 1e-9));
    }
}

typedef struct oblique_case {
    double vt, vn, mu, e;
    bool two_discs;
} oblique_case;

// Disc on a wall: the impulse along the wall takes all slip, which leaves 2/3 of the tangential
// speed, iff |vt| <= 3 mu (1 + e) vn; else it is mu times the normal impulse. Two equal discs share
// the change equally; what is told here is their relative motion.
static void oblique_impact_grips_or_slips(void **state)
{
    (void)state;
    const oblique_case cases[] = {
        { 2, 5, 0.5, 1, false },   { 2, 5, 0.05, 1, false }, { 6, 4, 0.3, 0.5, false },
        { 6, 4, 0.6, 0.5, false }, { 1, 3, 0.2, 0, false },  { 9, 3, 0.2, 0, false },
        { 2, 5, 0.5, 1, true },    { 2, 5, 0.05, 1, true },  { 6, 4, 0.3, 0.5, true },
    };
    for (size_t k = 0; k < sizeof cases / sizeof cases[0]; ++k) {
        const oblique_case *c = &cases[k];
        plumb_world *w = sim_space();
        plumb_material m = sim_material(w, c->mu, c->e);
        const double r = 0.5;
        plumb_body other = PLUMB_NULL_INIT;
        if (c->two_discs) {
            // They meet with centres one above the other.
            other = sim_ball(w, 0, 0, r, m);
        } else {
            sim_floor(w, m);
        }
        double height = c->two_discs ? 2 * r : r;
        double t = 0.51; // [s] until they meet
        plumb_body b = sim_ball(w, -c->vt * t, height + c->vn * t, r, m);
        sim_launch(w, b, c->vt, -c->vn, 0);
        sim_run(w, 60, HZ60);
        bool grips = c->vt <= 3 * c->mu * (1 + c->e) * c->vn;
        double change = grips ? c->vt / 3 : c->mu * (1 + c->e) * c->vn;
        double vt = c->vt - change, spin = -2 * change / r;
        double got_t = sim_vx(w, b), got_n = sim_vy(w, b), got_w = sim_w(w, b);
        if (c->two_discs) {
            got_t -= sim_vx(w, other), got_n -= sim_vy(w, other);
            // Each gets half the impulse of a wall on its mass: half the spin.
            spin /= 2;
        }
        double error_t = fabs(got_t - vt) / c->vn;
        double error_n = fabs(got_n - c->e * c->vn) / c->vn;
        double error_w = fabs(got_w - spin) * r / c->vn;
        print_message("oblique %g, %g, mu %.2f, e %.1f, %s, %s: off by %.2g, %.2g, spin %.2g\n",
                      c->vt, c->vn, c->mu, c->e, c->two_discs ? "discs" : "wall",
                      grips ? "grips" : "slips", error_t, error_n, error_w);
        // A bounce is put where and when it happens. Two discs meet where they turned out to be at
        // the start of the step: the line of their centres turns by the slip of a step over
        // their distance. Without bounce the contact takes hold up to a step's way early, and the
        // impulse along the wall acts that much farther out.
        double early = c->vn * HZ60 / r;
        double tolerance = c->two_discs ? 2 * c->vt * HZ60 / (2 * r)
                           : c->e > 0   ? SIM_TOLERANCE(1e-4, 1e-10)
                                        : early;
        assert_true(error_t <= tolerance && error_n <= tolerance && error_w <= tolerance);
        plumb_world_destroy(w);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(block_slides_its_distance),
        cmocka_unit_test(block_sticks_without_creep),
        cmocka_unit_test(block_slides_down),
        cmocka_unit_test(disc_rolls_down),
        cmocka_unit_test(sliding_disc_starts_to_roll),
        cmocka_unit_test(oblique_impact_grips_or_slips),
    };
    return cmocka_run_group_tests_name("friction", tests, NULL, NULL);
}
