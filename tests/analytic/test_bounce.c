// test_bounce.c - restitution against closed forms: apexes, energy, a ball in a box, elastic pairs,
// chains, the collisions that count out pi (Galperin 2003), a rod on a floor.
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "harness/sim.h"

#define HZ60 (1 / 60.0)

//---- one ball on a floor -------------------------------------------------------------------------

typedef struct apex_case {
    double e;
    double rate; // [1/s]
    int bounces;
    double tolerance; // relative
} apex_case;

// Height that the ball's lowest point would reach, from any moment of its flight.
static double reach(const plumb_world *w, plumb_body b, double r)
{
    double v = sim_vy(w, b);
    return sim_y(w, b) - r + v * v / (2 * SIM_G);
}

static void apexes_follow_the_restitution(void **state)
{
    (void)state;
    const double h = 5, r = 0.5;
    // The last bounce of e = 0.5 still flies for seven steps of 60 Hz.
    const apex_case cases[] = { { 0.5, 60, 4, 1e-4 },   { 0.8, 60, 12, 1e-4 },
                                { 1.0, 60, 50, 1e-4 },  { 0.9, 60, 20, 1e-4 },
                                { 0.5, 240, 5, 1e-4 },  { 0.8, 30, 8, 1e-4 },
                                { 0.3, 60, 2, 1e-4 },   { 0.1, 60, 1, 1e-4 },
                                { 0.14, 240, 2, 1e-4 }, { 0.05, 1000, 1, 1e-4 } };
    for (size_t k = 0; k < sizeof cases / sizeof cases[0]; ++k) {
        const apex_case *c = &cases[k];
        plumb_world *w = sim_world(&(plumb_world_desc){ 0 });
        plumb_material m = sim_material(w, 0, c->e);
        sim_floor(w, m);
        plumb_body b = sim_ball(w, 0, h + r, r, m);
        int bounce = 0;
        double worst = 0, before = 0;
        for (int i = 0; bounce < c->bounces && i < 100000; ++i) {
            sim_step(w, 1 / c->rate);
            double v = sim_vy(w, b);
            if (before > 0 && v <= 0) { // over the top
                ++bounce;
                double expected = h * pow(c->e, 2 * bounce);
                worst = fmax(worst, fabs(reach(w, b, r) / expected - 1));
            }
            before = v;
        }
        print_message("apexes e = %.2f at %4.0f Hz, %2d bounces: worst %.2g relative\n", c->e,
                      c->rate, bounce, worst);
        assert_int_equal(bounce, c->bounces);
        assert_true(worst <= c->tolerance);
        plumb_world_destroy(w);
    }
}

static void elastic_ball_keeps_its_energy(void **state)
{
    (void)state;
    const double drops[] = { 0.3, 1, 5 };
    for (size_t k = 0; k < 3; ++k) {
        plumb_world *w = sim_world(&(plumb_world_desc){ 0 });
        plumb_material m = sim_material(w, 0, 1);
        sim_floor(w, m);
        plumb_body b = sim_ball(w, 0, drops[k] + 0.5, 0.5, m);
        int bounces = 0;
        double worst = 0, before = 0;
        for (int i = 0; bounces < 1000 && i < 1000000; ++i) {
            sim_step(w, HZ60);
            double v = sim_vy(w, b);
            if (before > 0 && v <= 0) {
                ++bounces;
                worst = fmax(worst, fabs(reach(w, b, 0.5) / drops[k] - 1));
            }
            before = v;
        }
        print_message("e = 1 from %.1f m: %d bounces, energy within %.2g\n", drops[k], bounces,
                      worst);
        assert_int_equal(bounces, 1000);
        assert_true(worst <= 1e-5);
        plumb_world_destroy(w);
    }
}

//---- a ball in a box -----------------------------------------------------------------------------

// Frictionless box without gravity: |vx| and |vy| never change, and the path unfolds into a
// straight line, which tells the number of bounces on each pair of walls.
static void ball_in_a_box_never_sticks(void **state)
{
    (void)state;
    const double degrees[] = { 0.1, 1, 5, 30, 60, 89, 89.9 };
    const double width = 8, height = 5, r = 0.25, speed = 40;
    for (size_t k = 0; k < sizeof degrees / sizeof degrees[0]; ++k) {
        plumb_world *w = sim_space();
        plumb_material m = sim_material(w, 0, 1);
        plumb_body walls = sim_body(w, PLUMB_STATIC, 0, 0, 0);
        plumb_vec2 corner[4] = { sim_vec(0, 0), sim_vec(width, 0), sim_vec(width, height),
                                 sim_vec(0, height) };
        for (int i = 0; i < 4; ++i) {
            sim_add_segment(w, walls, corner[i], corner[(i + 1) % 4], m);
        }
        plumb_body b = sim_ball(w, width / 2, height / 2, r, m);
        double vx = speed * cos(degrees[k] * SIM_PI / 180);
        double vy = speed * sin(degrees[k] * SIM_PI / 180);
        sim_launch(w, b, vx, vy, 0);
        double bounces_a_second = vx / (width - 2 * r) + vy / (height - 2 * r);
        int steps = (int)(10000 / bounces_a_second * 60) + 60;
        int flips_x = 0, flips_y = 0;
        double worst = 0, last_x = vx, last_y = vy;
        for (int i = 0; i < steps; ++i) {
            sim_step(w, HZ60);
            double x = sim_vx(w, b), y = sim_vy(w, b);
            flips_x += x * last_x < 0, flips_y += y * last_y < 0;
            last_x = x, last_y = y;
            worst = fmax(worst, fmax(fabs(fabs(x) - vx), fabs(fabs(y) - vy)) / speed);
        }
        double t = steps * HZ60;
        double expected_x = vx * t / (width - 2 * r), expected_y = vy * t / (height - 2 * r);
        print_message("box, %4.1f degrees: %5d + %5d bounces (%.1f + %.1f), speed within %.2g\n",
                      degrees[k], flips_x, flips_y, expected_x, expected_y, worst);
        assert_true(flips_x + flips_y >= 10000);
        // An overlooked step of flight shifts the count; one bounce is left for rounding.
        assert_true(fabs(flips_x - expected_x) <= 1.5 && fabs(flips_y - expected_y) <= 1.5);
        assert_true(worst <= SIM_TOLERANCE(1e-5, 1e-10));
        assert_true(sim_x(w, b) > 0 && sim_x(w, b) < width);
        assert_true(sim_y(w, b) > 0 && sim_y(w, b) < height);
        plumb_world_destroy(w);
    }
}

//---- pairs and chains in one dimension -----------------------------------------------------------

typedef struct pair_case {
    double m1, m2, v1, v2, e;
    bool boxes;
} pair_case;

static plumb_body slider(plumb_world *w, double x, double mass, bool box, plumb_material m)
{
    plumb_body b = box ? sim_crate(w, x, 0, 0.5, 0.5, m) : sim_ball(w, x, 0, 0.5, m);
    assert_int_equal(plumb_body_set_mass(w, b, (plumb_real)mass), PLUMB_OK);
    return b;
}

static void pair_leaves_as_the_impact_law_says(void **state)
{
    (void)state;
    const pair_case cases[] = {
        { 1, 1, 5, 0, 1, false },     { 1, 1, 5, 0, 1, true },     { 1, 1, 5, -3, 0.5, false },
        { 2, 1, 5, -3, 1, true },     { 1, 10, 8, 0, 1, false },   { 10, 1, 8, -1, 0.25, true },
        { 1000, 1, 3, -3, 1, false }, { 1, 1000, 9, 1, 1, true },  { 3, 2, 6, 1, 0, false },
        { 1e6, 1, 2, 0, 1, false },   { 1, 1, 5, -3, 0.1, false }, { 10, 1, 8, -1, 0.14, true },
        { 1, 1000, 9, 1, 0.1, true },
    };
    for (size_t k = 0; k < sizeof cases / sizeof cases[0]; ++k) {
        const pair_case *c = &cases[k];
        plumb_world *w = sim_space();
        plumb_material m = sim_material(w, 0, c->e);
        plumb_body a = slider(w, -1, c->m1, c->boxes, m), b = slider(w, 1, c->m2, c->boxes, m);
        sim_launch(w, a, c->v1, 0, 0);
        sim_launch(w, b, c->v2, 0, 0);
        sim_run(w, 60, HZ60);
        // v' = centre's velocity -+ e times the approach, shared inversely to mass.
        double mean = (c->m1 * c->v1 + c->m2 * c->v2) / (c->m1 + c->m2);
        double approach = c->v1 - c->v2;
        double v1 = mean - c->e * approach * c->m2 / (c->m1 + c->m2);
        double v2 = mean + c->e * approach * c->m1 / (c->m1 + c->m2);
        double error = fmax(fabs(sim_vx(w, a) - v1), fabs(sim_vx(w, b) - v2)) / approach;
        print_message("pair %g : %g, e = %.2f, %s: error %.2g\n", c->m1, c->m2, c->e,
                      c->boxes ? "boxes" : "discs", error);
        // A rounding each of impulse, mass and velocity; the light one sees the heavy one's.
        assert_true(error <= 32 * SIM_EPSILON);
        plumb_world_destroy(w);
    }
}

// Discs of any size and speed strike one another off the centre, in steps of any length: they part along the line of
// centres of the moment at which they meet, not of a quarter of a millimetre before.
static void discs_leave_by_the_line_of_their_centres(void **state)
{
    (void)state;
    const double hertz[] = { 30, 60, 120, 240, 1000, 4000 };
    uint32_t seed = 20;
    double worst = 0;
    for (int k = 0; k < 1200; ++k) {
        const double r1 = sim_uniform(&seed, 0.02, 1), r2 = sim_uniform(&seed, 0.02, 1);
        const double m1 = sim_uniform(&seed, 0.1, 10), m2 = sim_uniform(&seed, 0.1, 10);
        const double speed = sim_uniform(&seed, 0.5, 20), turn = sim_uniform(&seed, 0, 2 * SIM_PI);
        const double e = k % 3 == 0 ? sim_uniform(&seed, 0.2, 1) : 1, r = r1 + r2;
        const double aside = sim_uniform(&seed, -0.9, 0.9) * r, dt = 1 / hertz[k % 6];
        const double c = cos(turn), s = sin(turn), way = sqrt(r * r - aside * aside);
        const double far = way + sim_uniform(&seed, 0.001, 4) * speed * dt;
        plumb_world *w = sim_space();
        plumb_material m = sim_material(w, 0, e);
        plumb_body a = sim_ball(w, -far * c - aside * s, -far * s + aside * c, r1, m);
        plumb_body b = sim_ball(w, 0, 0, r2, m);
        assert_int_equal(plumb_body_set_mass(w, a, (plumb_real)m1), PLUMB_OK);
        assert_int_equal(plumb_body_set_mass(w, b, (plumb_real)m2), PLUMB_OK);
        sim_launch(w, a, speed * c, speed * s, 0);
        sim_run(w, 7, dt);
        // From A to B when they meet: (way, -aside) over r, in the frame of the flight.
        const double nx = (way * c + aside * s) / r, ny = (way * s - aside * c) / r;
        const double gets = (1 + e) * speed * (way / r) * m1 / (m1 + m2);
        const double off = hypot(sim_vx(w, b) - gets * nx, sim_vy(w, b) - gets * ny) / speed;
        if (off > 4e-5) {
            print_message("case %d: off by %.2g of %.3g m/s, r %.3g, aside %.2g, e %.2g, %g Hz\n",
                          k, off, speed, r, aside / r, e, hertz[k % 6]);
        }
        worst = fmax(worst, off);
        assert_true(off <= 4e-5);
        plumb_world_destroy(w);
    }
    print_message("1200 cuts: velocities within %.2g of the speed\n", worst);
}

// n equal balls in a row, k of them arrive: k leave, the others stay.
static void cradle_passes_on_what_arrives(void **state)
{
    (void)state;
    enum { COUNT = 7 };
    const double gaps[] = { 0, 1e-3, 0.05 };
    for (int g = 0; g < 3; ++g) {
        for (int k = 1; k < COUNT; ++k) {
            plumb_world *w = sim_space();
            plumb_material m = sim_material(w, 0, 1);
            plumb_body ball[COUNT];
            for (int i = 0; i < COUNT; ++i) {
                double x = i * (1 + gaps[g]) - (i < k ? 2 : 0);
                ball[i] = sim_ball(w, x, 0, 0.5, m);
                sim_launch(w, ball[i], i < k ? 4 : 0, 0, 0);
            }
            sim_run(w, 90, HZ60);
            double worst = 0;
            for (int i = 0; i < COUNT; ++i) {
                double expected = i >= COUNT - k ? 4 : 0;
                worst = fmax(worst, fabs(sim_vx(w, ball[i]) - expected) / 4);
            }
            double lost = fabs(sim_energy(w) / (k * (double)plumb_body_mass(w, ball[0]) * 8) - 1);
            print_message("cradle %d in, gap %g: velocities within %.2g, energy within %.2g\n", k,
                          gaps[g], worst, lost);
            assert_true(worst <= 1e-4);
            assert_true(lost <= 1e-4);
            plumb_world_destroy(w);
        }
    }
}

typedef struct pi_case {
    double ratio; // of masses
    int expected; // floor(pi sqrt(ratio))
    double rate;  // [1/s]
} pi_case;

// The same collisions one by one; returns their number and the last velocities.
static int collide_one_by_one(double ratio, double *light, double *heavy)
{
    int count = 0;
    *light = 0, *heavy = -1;
    while (*heavy < *light || *light < 0) {
        if (*heavy < *light) {
            double l = ((1 - ratio) * *light + 2 * ratio * *heavy) / (1 + ratio);
            *heavy = ((ratio - 1) * *heavy + 2 * *light) / (1 + ratio);
            *light = l;
        } else {
            *light = -*light;
        }
        ++count;
    }
    return count;
}

// A heavy block pushes a light one against a wall: with all impacts elastic they number
// floor(pi sqrt(ratio)).
static void collisions_count_out_pi(void **state)
{
    (void)state;
    const pi_case cases[] = { { 1, 3, 60 },        { 100, 31, 60 },     { 100, 31, 1000 },
                              { 10000, 314, 60 },  { 10000, 314, 240 }, { 1e5, 993, 60 },
                              { 1e6, 3141, 60 },   { 1e6, 3141, 240 },  { 1e8, 31415, 60 },
                              { 1e8, 31415, 1000 } };
    int wrong = 0;
    for (size_t k = 0; k < sizeof cases / sizeof cases[0]; ++k) {
        const pi_case *c = &cases[k];
        plumb_world *w = sim_space();
        plumb_material m = sim_material(w, 0, 1);
        plumb_body wall = sim_body(w, PLUMB_STATIC, -1, 0, 0);
        sim_add_box(w, wall, 1, 5, m);
        plumb_body light = slider(w, 1.5, 1, true, m);
        plumb_body heavy = slider(w, 4, c->ratio, true, m);
        assert_int_equal(plumb_body_set_fixed_rotation(w, light, true), PLUMB_OK);
        assert_int_equal(plumb_body_set_fixed_rotation(w, heavy, true), PLUMB_OK);
        sim_launch(w, heavy, -1, 0, 0);
        int count = 0;
        for (int i = 0; i < (int)(20 * c->rate); ++i) {
            sim_step(w, 1 / c->rate);
            count += (int)plumb_world_stats(w).bounce_count;
        }
        double v_light, v_heavy;
        assert_int_equal(collide_one_by_one(c->ratio, &v_light, &v_heavy), c->expected);
        double error =
            fabs(sim_vx(w, light) - v_light) / sqrt(c->ratio) + fabs(sim_vx(w, heavy) - v_heavy);
        print_message("pi: masses 1 : %g at %g Hz: %d collisions, %d expected, last velocities off "
                      "by %.2g\n",
                      c->ratio, c->rate, count, c->expected, error);
        // Each collision rounds a few times.
        wrong += count != c->expected || !(error <= 8 * c->expected * SIM_EPSILON);
        plumb_world_destroy(w);
    }
    assert_int_equal(wrong, 0);
}

static void count_warnings(void *context, plumb_log_level level, const char *message)
{
    (void)message;
    *(int *)context += level == PLUMB_LOG_WARN;
}

// 3,141,592 impacts, most of them within a substep: more than are followed.
static void a_cut_chain_is_told(void **state)
{
    (void)state;
    int warnings = 0;
    plumb_world *w = NULL;
    plumb_world_desc desc = { .log = count_warnings,
                              .hook_context = &warnings,
                              .zero_gravity = true };
    assert_int_equal(plumb_world_create(&desc, &w), PLUMB_OK);
    plumb_material m = sim_material(w, 0, 1);
    plumb_body wall = sim_body(w, PLUMB_STATIC, -1, 0, 0);
    sim_add_box(w, wall, 1, 5, m);
    plumb_body light = slider(w, 1.5, 1, true, m);
    plumb_body heavy = slider(w, 4, 1e12, true, m);
    assert_int_equal(plumb_body_set_fixed_rotation(w, light, true), PLUMB_OK);
    assert_int_equal(plumb_body_set_fixed_rotation(w, heavy, true), PLUMB_OK);
    sim_launch(w, heavy, -1, 0, 0);
    sim_run(w, 60, HZ60);
    assert_int_equal(plumb_world_stats(w).cut_chain_count, 0);
    sim_run(w, 4 * 60, HZ60);
    print_message("pi: masses 1 : 1e12: %u cut chains, %d warnings\n",
                  plumb_world_stats(w).cut_chain_count, warnings);
    assert_true(plumb_world_stats(w).cut_chain_count > 0);
    assert_int_equal(warnings, 1);
    plumb_world_destroy(w);
}

//---- a rod on the floor --------------------------------------------------------------------------

typedef struct rod_case {
    double degrees, e;
} rod_case;

// J = (1 + e) v / (1 / m + x^2 / I), x the distance of the struck corner from the centre along the
// floor (impulse and angular impulse of a rigid body).
static void rod_turns_when_its_end_strikes(void **state)
{
    (void)state;
    const rod_case cases[] = { { 30, 1 },   { 30, 0.5 }, { 60, 1 },   { 45, 0.8 },
                               { 10, 0.5 }, { 80, 1 },   { 30, 0.1 }, { 75, 0.14 } };
    for (size_t k = 0; k < sizeof cases / sizeof cases[0]; ++k) {
        const rod_case *c = &cases[k];
        plumb_world *w = sim_space();
        plumb_material m = sim_material(w, 0, c->e);
        sim_floor(w, m);
        const double hx = 1, hy = 0.02, speed = 3;
        plumb_body rod = sim_body(w, PLUMB_DYNAMIC, 0, 1.5, c->degrees * SIM_PI / 180);
        sim_add_box(w, rod, hx, hy, m);
        sim_launch(w, rod, 0, -speed, 0);
        for (int i = 0; i < 600 && sim_vy(w, rod) <= -speed; ++i) {
            sim_step(w, 1 / 600.0);
        }
        double turn = c->degrees * SIM_PI / 180;
        double x = -hx * cos(turn) + hy * sin(turn); // the lowest corner is (-hx, -hy)
        double mass = (double)plumb_body_mass(w, rod), inertia = (double)plumb_body_inertia(w, rod);
        double j = (1 + c->e) * speed / (1 / mass + x * x / inertia);
        double dv = fabs(sim_vy(w, rod) - (j / mass - speed)) / speed;
        double dw = fabs(sim_w(w, rod) - x * j / inertia) * hx / speed;
        print_message("rod at %2.0f degrees, e = %.2f: error %.2g of v, %.2g of spin\n", c->degrees,
                      c->e, dv, dw);
        assert_true(dv <= SIM_TOLERANCE(1e-5, 1e-12) && dw <= SIM_TOLERANCE(1e-5, 1e-12));
        plumb_world_destroy(w);
    }
}

// The count of impacts is the last step's: in free flight there are none.
static void impacts_are_counted_where_they_happen(void **state)
{
    (void)state;
    const double bounces[] = { 0.8, 0.1 };
    for (int k = 0; k < 2; ++k) {
        plumb_world *w = sim_world(&(plumb_world_desc){ 0 });
        plumb_material m = sim_material(w, 0, bounces[k]);
        sim_floor(w, m);
        plumb_body b = sim_ball(w, 0, 2.5, 0.5, m);
        int counted = 0;
        for (int i = 0; i < 40; ++i) {
            const double before = sim_vy(w, b);
            sim_step(w, HZ60);
            const int count = (int)plumb_world_stats(w).bounce_count;
            assert_int_equal(count, before < 0 && sim_vy(w, b) > 0);
            counted += count;
        }
        assert_int_equal(counted, 1);
        plumb_world_destroy(w);
    }
}

// Between two plates a ball of e = 1.25 has 1.25^n of its speed after n bounces, until that is the cap; what comes faster
// leaves as it came. A box that lands flat does not turn; two bodies keep their momentum.
static void bumpers_give_energy_up_to_the_cap(void **state)
{
    (void)state;
    const plumb_solver solvers[] = { PLUMB_SOLVER_SOFT, PLUMB_SOLVER_PGS, PLUMB_SOLVER_EXACT };
    for (int k = 0; k < 3 * 4; ++k) {
        const double speed = k % 2 == 0 ? 1 : 6;
        const bool box = k / 2 % 2 == 1;
        plumb_world *w = sim_world(&(plumb_world_desc){ .solver = solvers[k / 4],
                                                        .zero_gravity = true,
                                                        .restitution_cap = 4,
                                                        .no_sleep = true });
        plumb_material bumper = sim_material(w, 0, 1.25);
        for (int side = -1; side <= 1; side += 2) {
            plumb_body plate = sim_body(w, PLUMB_STATIC, 2 * side, 0, 0);
            sim_add_box(w, plate, 0.5, 3, bumper);
        }
        plumb_material plain = sim_material(w, 0, 0);
        plumb_body b = box ? sim_crate(w, 0, 0, 0.4, 0.4, plain) : sim_ball(w, 0, 0, 0.4, plain);
        sim_launch(w, b, speed, 0, 0);
        double expected = speed, before = speed;
        int bounces = 0;
        for (int i = 0; i < 600; ++i) {
            sim_step(w, HZ60);
            const double v = sim_vx(w, b);
            if (v * before < 0) {
                ++bounces;
                expected = expected > 4 ? expected : fmin(1.25 * expected, 4);
            }
            assert_true(fabs(fabs(v) - expected) < SIM_TOLERANCE(1e-4, 1e-9));
            before = v;
        }
        assert_true(bounces > 10 && fabs(sim_w(w, b)) < 1e-5);
        plumb_world_destroy(w);
    }
    plumb_world *w = sim_space();
    plumb_material bumper = sim_material(w, 0, 1.5);
    plumb_body a = sim_ball(w, -1, 0, 0.5, bumper), b = sim_ball(w, 1, 0, 0.25, bumper);
    sim_launch(w, a, 2, 0, 0);
    sim_run(w, 60, HZ60);
    // Masses 4 : 1; what was 2 between them is 3.
    assert_true(fabs(sim_vx(w, b) - sim_vx(w, a) - 3) < SIM_TOLERANCE(1e-5, 1e-12));
    assert_true(fabs(4 * sim_vx(w, a) + sim_vx(w, b) - 8) < SIM_TOLERANCE(1e-5, 1e-12));
    plumb_world_destroy(w);
}

// A ball that lies still between bumpers is given nothing; one that is thrown among many never leaves faster than the cap lets
// it, whatever it strikes, and no chain of impacts goes on without end.
static void bumpers_end_at_the_cap(void **state)
{
    (void)state;
    plumb_world *w = sim_world(&(plumb_world_desc){ .restitution_cap = 5 });
    plumb_material bumper = sim_material(w, 0, 3);
    sim_floor(w, bumper);
    for (int side = -1; side <= 1; side += 2) {
        plumb_body wall = sim_body(w, PLUMB_STATIC, 3 * side, 0, 0);
        sim_add_box(w, wall, 0.5, 100, bumper);
    }
    plumb_body balls[9];
    for (int i = 0; i < 9; ++i) {
        balls[i] = sim_ball(w, -1.2 + 1.2 * (i % 3), 1 + 1.1 * (i / 3), 0.3, bumper);
    }
    double fastest = 0, slowest = HUGE_VAL;
    for (int i = 0; i < 3000; ++i) {
        sim_step(w, HZ60);
        double sum = 0;
        for (int k = 0; k < 9; ++k) {
            const double vx = sim_vx(w, balls[k]), vy = sim_vy(w, balls[k]);
            sum += vx * vx + vy * vy;
        }
        fastest = fmax(fastest, sqrt(sum / 9));
        slowest = i > 300 ? fmin(slowest, sqrt(sum / 9)) : slowest;
    }
    print_message("nine balls among bumpers: root mean square %.2f to %.2f m/s\n", slowest,
                  fastest);
    // Each direction has the cap at most, and two that meet have it between them; gravity gives what it takes.
    assert_true(fastest < 12 && slowest > 0.5);
    plumb_world_destroy(w);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(apexes_follow_the_restitution),
        cmocka_unit_test(elastic_ball_keeps_its_energy),
        cmocka_unit_test(ball_in_a_box_never_sticks),
        cmocka_unit_test(pair_leaves_as_the_impact_law_says),
        cmocka_unit_test(discs_leave_by_the_line_of_their_centres),
        cmocka_unit_test(cradle_passes_on_what_arrives),
        cmocka_unit_test(collisions_count_out_pi),
        cmocka_unit_test(a_cut_chain_is_told),
        cmocka_unit_test(rod_turns_when_its_end_strikes),
        cmocka_unit_test(impacts_are_counted_where_they_happen),
        cmocka_unit_test(bumpers_give_energy_up_to_the_cap),
        cmocka_unit_test(bumpers_end_at_the_cap),
    };
    return cmocka_run_group_tests_name("bounce", tests, NULL, NULL);
}
