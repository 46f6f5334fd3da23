// test_limits.c - limits: sliders, hinges and ropes that bounce, against closed forms; and what is met without restitution stops.
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

static const plumb_solver solvers[] = { PLUMB_SOLVER_SOFT, PLUMB_SOLVER_PGS, PLUMB_SOLVER_EXACT };
static const char *const names[] = { "soft", "pgs", "exact" };

static plumb_body mass(plumb_world *w, double x, double y, double kg, double inertia)
{
    plumb_body b = plumb_body_create(w, &(plumb_body_desc){ .position = sim_vec(x, y),
                                                            .mass = (plumb_real)kg,
                                                            .inertia = (plumb_real)inertia });
    assert_false(plumb_is_null(b));
    return b;
}

// Largest value that `j` reaches in `steps` behind its next blow, less `bound`.
static double next_height(plumb_world *w, plumb_joint j, double bound, int steps)
{
    double last = (double)plumb_joint_value(w, j), most = bound;
    bool struck = false;
    for (int i = 0; i < steps; ++i) {
        sim_step(w, DT);
        const double now = (double)plumb_joint_value(w, j);
        if (struck && now < last) {
            return most - bound;
        }
        struck |= now > last;
        most = struck ? fmax(most, now) : bound;
        last = now;
    }
    return most - bound;
}

// A weight on a slider that leans by `lean` from upright falls 1 m to its limit, and rises by e^2n m.
static void sliders_rise_by_the_square(void **state)
{
    (void)state;
    const double cases[][2] = { { 0, 1 }, { 0, 0.5 }, { 0.6, 1 }, { 0.6, 0.5 } };
    for (size_t i = 0; i < 12; ++i) {
        const double lean = cases[i % 4][0], e = cases[i % 4][1];
        const double x = sin(lean), y = cos(lean);
        plumb_world *w =
            sim_world(&(plumb_world_desc){ .solver = solvers[i / 4], .no_sleep = true });
        plumb_body b = mass(w, x, y, 2, 0.1);
        plumb_joint j = sim_joint(w, (plumb_joint_desc){ .kind = PLUMB_PRISMATIC,
                                                         .body_b = b,
                                                         .anchor = sim_vec(x, y),
                                                         .axis = sim_vec(x, y),
                                                         .enable_limit = true,
                                                         .lower = -1,
                                                         .upper = 9,
                                                         .restitution = (plumb_real)e });
        double worst = 0, wanted = 1;
        for (int n = 0; n < (e < 1 ? 3 : 20); ++n) {
            wanted *= e * e;
            // The top lies between two steps: lower by at most a (dt / 2)^2 / 2.
            worst = fmax(worst, fabs(next_height(w, j, -1, 200) - wanted));
        }
        print_message("%s: slider leaning by %g, e = %g: heights within %.2g m\n", names[i / 4],
                      lean, e, worst);
        assert_true(worst <
                    (e < 1 ? SIM_G * DT * DT / 8 * 1.1 : 1.5e-3)); // rounding in the far build
        plumb_world_destroy(w);
    }
}

// A rod let fall from level about a hinge at its end, to a limit at 60 degrees below: it comes back to e^2 of the height. The
// classic solver damps the swing itself.
static void rods_come_back_from_their_limit(void **state)
{
    (void)state;
    for (size_t i = 0; i < 6; ++i) {
        const double e = i % 2 == 0 ? 1 : 0.5, bound = SIM_PI / 3;
        plumb_world *w =
            sim_world(&(plumb_world_desc){ .solver = solvers[i / 2], .no_sleep = true });
        plumb_body rod = mass(w, 0.5, 0, 3, 3.0 / 12);
        plumb_joint j = sim_joint(w, (plumb_joint_desc){ .kind = PLUMB_REVOLUTE,
                                                         .body_b = rod,
                                                         .enable_limit = true,
                                                         .lower = (plumb_real)-bound,
                                                         .upper = 3,
                                                         .restitution = (plumb_real)e });
        double energy = 0, most = 0;
        for (int n = 0; n < (e < 1 ? 1 : 10); ++n) {
            const double angle = next_height(w, j, -bound, 400) - bound;
            energy = 1 + sin(angle) / sin(bound);
            most = fmax(most, fabs(energy - (e < 1 ? e * e : 1)));
        }
        print_message("%s: rod at its limit, e = %g: height off by %.2g\n", names[i / 2], e, most);
        const double bounds[][2] = { { 0.03, 1.5e-3 }, { 0.5, 0.04 }, { 0.08, 6e-3 } };
        assert_true(most < bounds[i / 2][i % 2]);
        plumb_world_destroy(w);
    }
}

// A ball on a slack rope of 1 m falls from 0.5 m beside and above: at the end of the rope the speed along it turns round,
// what is across stays. Flight is a parabola until then.
static void ropes_throw_back(void **state)
{
    (void)state;
    for (size_t i = 0; i < 6; ++i) {
        const double e = i % 2 == 0 ? 1 : 0.5, x = 0.5;
        const double h = sqrt(1 - x * x), v = sqrt(2 * SIM_G * h), t = sqrt(2 * h / SIM_G);
        const double nx = x, ny = -h; // of the rope at its end
        const double along = -v * ny, after = e < 1 ? 0.1 : 0.25;
        plumb_world *w =
            sim_world(&(plumb_world_desc){ .solver = solvers[i / 2], .no_sleep = true });
        plumb_body ball = mass(w, x, 0, 0.7, 0);
        sim_joint(w, (plumb_joint_desc){ .kind = PLUMB_DISTANCE,
                                         .body_b = ball,
                                         .anchor_b = sim_vec(x, 0),
                                         .enable_limit = true,
                                         .upper = 1,
                                         .restitution = (plumb_real)e });
        const int steps = (int)((t + after) / DT);
        sim_run(w, steps, DT);
        const double s = steps * DT - t, vx = -(1 + e) * along * nx, vy = -v - (1 + e) * along * ny;
        const double off = hypot(sim_x(w, ball) - (x + vx * s),
                                 sim_y(w, ball) - (-h + vy * s - SIM_G * s * s / 2));
        print_message("%s: ball on a rope, e = %g: off by %.2g m\n", names[i / 2], e, off);
        assert_true(off < SIM_TOLERANCE(5e-6, 1e-6));
        plumb_world_destroy(w);
    }
}

// Four rods that hang together, with elbows that give all back: what other joints hold takes its share, and nothing is won.
static void chains_with_elastic_elbows_win_nothing(void **state)
{
    (void)state;
    for (int k = 0; k < 3; ++k) {
        plumb_world *w = sim_world(&(plumb_world_desc){ .solver = solvers[k], .no_sleep = true });
        plumb_body last = PLUMB_NULL_INIT;
        for (int i = 0; i < 4; ++i) {
            plumb_body rod = mass(w, i + 0.5, 0, 1, 1.0 / 12);
            sim_joint(w, (plumb_joint_desc){ .kind = PLUMB_REVOLUTE,
                                             .body_a = last,
                                             .body_b = rod,
                                             .anchor = sim_vec(i, 0),
                                             .enable_limit = true,
                                             .lower = (plumb_real)(i == 0 ? -3 : -0.5),
                                             .upper = (plumb_real)0.5,
                                             .restitution = 1 });
            last = rod;
        }
        const plumb_energy start = plumb_world_energy(w);
        double most = -1e9, end = 0;
        for (int i = 0; i < 1800; ++i) {
            sim_step(w, DT);
            const plumb_energy now = plumb_world_energy(w);
            end = (double)now.kinetic + (double)now.potential -
                  ((double)start.kinetic + (double)start.potential);
            most = fmax(most, end);
        }
        print_message("%s: elbows: %.3g J more at most, %.3g J at the end of 30 s\n", names[k],
                      most, end);
        assert_true(most < 0.1);
        plumb_world_destroy(w);
    }
}

// What bounces lower and lower comes to rest on its limit, and falls asleep there.
static void what_bounces_comes_to_rest(void **state)
{
    (void)state;
    for (int k = 0; k < 3; ++k) {
        plumb_world *w = sim_world(&(plumb_world_desc){ .solver = solvers[k] });
        plumb_body b = mass(w, 0, 1, 2, 0.1);
        plumb_joint j = sim_joint(w, (plumb_joint_desc){ .kind = PLUMB_PRISMATIC,
                                                         .body_b = b,
                                                         .anchor = sim_vec(0, 1),
                                                         .axis = sim_vec(0, 1),
                                                         .enable_limit = true,
                                                         .lower = -1,
                                                         .upper = 9,
                                                         .restitution = (plumb_real)0.5 });
        sim_run(w, 600, DT);
        print_message("%s: rests at %g\n", names[k], (double)plumb_joint_value(w, j));
        assert_near(plumb_joint_value(w, j), -1, 6e-3);
        assert_true(!plumb_body_is_awake(w, b));
        plumb_world_destroy(w);
    }
}

// Slower than the world's restitution_speed nothing bounces; a blow counts in what breaks a joint: (1 + e) m v.
static void thresholds_and_blows(void **state)
{
    (void)state;
    for (int k = 0; k < 3; ++k) {
        plumb_world *w = sim_world(&(plumb_world_desc){
            .solver = solvers[k], .zero_gravity = true, .no_sleep = true, .restitution_speed = 1 });
        plumb_joint_desc d = { .kind = PLUMB_PRISMATIC,
                               .enable_limit = true,
                               .lower = -1,
                               .upper = (plumb_real)0.5,
                               .restitution = 1 };
        const plumb_body slow = d.body_b = mass(w, 0, 0, 2, 0.1);
        sim_launch(w, slow, 0.9, 0, 0);
        sim_joint(w, d);
        d.body_b = mass(w, 0, 3, 2, 0.1);
        d.anchor = sim_vec(0, 3);
        d.break_impulse = (plumb_real)7.9; // of 2 * 2 * 2
        sim_launch(w, d.body_b, 2, 0, 0);
        plumb_joint weak = sim_joint(w, d);
        plumb_body b = d.body_b = mass(w, 0, 6, 2, 0.1);
        d.anchor = sim_vec(0, 6);
        d.break_impulse = (plumb_real)8.1;
        sim_launch(w, d.body_b, 2, 0, 0);
        plumb_joint strong = sim_joint(w, d);
        sim_run(w, 45, DT);
        assert_false(plumb_joint_valid(w, weak));
        assert_true(plumb_joint_valid(w, strong));
        assert_near(sim_vx(w, b), -2, 1e-4);
        assert_near(sim_vx(w, slow), 0, 1e-4);
        plumb_world_destroy(w);
    }
}

//---- without restitution --------------------------------------------------------------------------

typedef struct stop {
    plumb_body body;
    plumb_joint joint;
    double bound, rate; // of the value; what it comes at
} stop;

// A body on a hinge or slider of the world that is beside its centre, at random, flies towards a limit that it meets within 0.2 to
// 0.8 s. What breaks by impulse is solved alone, the others in lanes.
static stop throw_at_limit(plumb_world *w, uint32_t number)
{
    uint32_t seed = 104729 * number + 11;
    const double x = 20.0 * (number % 8), y = 20.0 * (number / 8);
    const double lean = sim_uniform(&seed, -3, 3), arm = sim_uniform(&seed, -2, 2);
    const double rate = sim_uniform(&seed, 0.2, 3), way = rate * sim_uniform(&seed, 0.2, 0.8);
    const double sign = number % 2 ? -1 : 1;
    const bool hinge = sim_random(&seed) % 2, alone = sim_random(&seed) % 2;
    stop out = { .bound = sign * way, .rate = sign * rate };
    out.body = mass(w, x, y, sim_uniform(&seed, 0.1, 10), sim_uniform(&seed, 0.05, 2));
    plumb_body_set_angle(w, out.body, (plumb_real)sim_uniform(&seed, -3, 3));
    const double ax = cos(lean), ay = sin(lean);
    plumb_joint_desc d = { .kind = hinge ? PLUMB_REVOLUTE : PLUMB_PRISMATIC,
                           .body_b = out.body,
                           .anchor = sim_vec(x - arm * ay, y + arm * ax),
                           .enable_limit = true,
                           .lower = (plumb_real)(sign > 0 ? -0.5 : out.bound),
                           .upper = (plumb_real)(sign > 0 ? out.bound : 0.5),
                           .break_impulse = alone ? 10000 : 0 };
    if (hinge) {
        // v = w x (from the anchor to the centre)
        sim_launch(w, out.body, -out.rate * -arm * ax, out.rate * arm * ay, out.rate);
    } else {
        d.axis = sim_vec(ax, ay);
        sim_launch(w, out.body, out.rate * ax, out.rate * ay, 0);
    }
    out.joint = sim_joint(w, d);
    return out;
}

// After a second it stands at the limit, but for what it comes by in a substep: a hinge far beside the centre gives way to the blow,
// and comes back.
static void what_meets_a_limit_stops(void **state)
{
    (void)state;
    for (int k = 0; k < 4; ++k) {
        const plumb_solver solver = k % 2 ? PLUMB_SOLVER_PGS : PLUMB_SOLVER_SOFT;
        const int rate = k < 2 ? 60 : 240;
        plumb_world *w = sim_world(&(plumb_world_desc){ .solver = solver, .no_sleep = true });
        plumb_world_set_gravity(w, sim_vec(0, 0));
        const trials t = trials_from(0, 48);
        const uint32_t count = t.end - t.first < 48 ? t.end - t.first : 48;
        stop all[48];
        for (uint32_t i = 0; i < count; ++i) {
            all[i] = throw_at_limit(w, t.first + i);
            assert_near(plumb_joint_rate(w, all[i].joint), all[i].rate, 1e-4);
        }
        sim_run(w, rate, 1.0 / rate);
        double off = 0, left = 0;
        for (uint32_t i = 0; i < count; ++i) {
            const double value = (double)plumb_joint_value(w, all[i].joint);
            off = fmax(off, fabs(value - all[i].bound) * (solver == PLUMB_SOLVER_SOFT ? 4 : 1) *
                                rate / fabs(all[i].rate));
            left = fmax(left, fabs((double)plumb_joint_rate(w, all[i].joint) / all[i].rate));
        }
        print_message("%s, %d Hz: %.1g of the speed is left, %.2g substeps off the limit\n",
                      names[k % 2], rate, left, off);
        assert_true(left < 2e-3);
        assert_true(off < 1.5);
        plumb_world_destroy(w);
    }
}

// Bounds that are moved far from a hinge's value are met where they are, not full turns away: it turns back in steps that can be told.
static void a_bound_far_away_is_met_on_its_turn(void **state)
{
    (void)state;
    for (size_t i = 0; i < 3; ++i) {
        for (double gap = 0.5; gap < 20; gap *= 1.3) {
            for (int side = -1; side <= 1; side += 2) {
                plumb_world *w = sim_world(&(plumb_world_desc){
                    .solver = solvers[i], .zero_gravity = true, .no_sleep = true });
                const plumb_body b = mass(w, 1, 0, 1, 0.1);
                const plumb_joint j =
                    sim_joint(w, (plumb_joint_desc){ .kind = PLUMB_REVOLUTE, .body_b = b });
                const double near = side * gap, far = side * (gap + 0.3);
                plumb_joint_set_limit(w, j, true, (plumb_real)fmin(near, far),
                                      (plumb_real)fmax(near, far));
                sim_run(w, 600, DT);
                assert_near(plumb_joint_value(w, j), near, 0.02);
                plumb_world_destroy(w);
            }
        }
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(what_meets_a_limit_stops),
        cmocka_unit_test(a_bound_far_away_is_met_on_its_turn),
        cmocka_unit_test(sliders_rise_by_the_square),
        cmocka_unit_test(rods_come_back_from_their_limit),
        cmocka_unit_test(ropes_throw_back),
        cmocka_unit_test(chains_with_elastic_elbows_win_nothing),
        cmocka_unit_test(what_bounces_comes_to_rest),
        cmocka_unit_test(thresholds_and_blows),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
