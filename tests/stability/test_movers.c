// test_movers.c - what moves fast and meets what moves: kinematic paddles, bullets, and bodies that ask not to
// pass. What stands still: test_tunnelling.c.
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "space.h"

//---- what moves ----------------------------------------------------------------------------------

// A kinematic paddle that travels and turns sweeps over resting balls: none is on its other side
// after a step in which it was within the paddle's reach before and after.
static void kinematic_paddle_passes_no_ball(void **state)
{
    (void)state;
    const double speeds[] = { 0, 5, 30, 100 }, spins[] = { 0, 5, 30, 100, 300 };
    for (int solver = 0; solver < 2; ++solver) {
        int swept = 0;
        for (int i = 1; i < 20; ++i) {
            double speed = speeds[i % 4], spin = spins[i / 4];
            plumb_world *w = space(solver);
            plumb_material m = sim_material(w, 0.2, 0);
            plumb_body paddle = sim_body(w, PLUMB_KINEMATIC, 0, 0, 0);
            sim_add_box(w, paddle, ROD_HALF_W, ROD_HALF, m);
            sim_launch(w, paddle, speed, 0, spin);
            plumb_body balls[40];
            double side[40];
            for (int k = 0; k < 40; ++k) {
                double x = 0.4 + 0.5 * (k / 8), y = -1.75 + 0.5 * (k % 8);
                balls[k] = sim_ball(w, x, y, 0.08, m);
                side[k] = hypot(x, y) < ROD_HALF ? 1 : 0;
            }
            for (int step = 0; step < 30; ++step) {
                sim_step(w, HZ60);
                for (int k = 0; k < 40; ++k) {
                    plumb_vec2 p = plumb_body_local_point(
                        w, paddle, sim_vec(sim_x(w, balls[k]), sim_y(w, balls[k])));
                    bool near = fabs((double)p.y) < ROD_HALF &&
                                (spin > 0 ? hypot((double)p.x, (double)p.y) < ROD_HALF : true);
                    if (!near) {
                        side[k] = 0; // it may come round the paddle's end
                        continue;
                    }
                    if (!(side[k] * (double)p.x >= 0)) {
                        print_message("%s: %g m/s, %g rad/s: ball %d after step %d at %g, %g\n",
                                      solver_name(solver), speed, spin, k, step, (double)p.x,
                                      (double)p.y);
                    }
                    assert_true(side[k] * (double)p.x >= 0);
                    swept += side[k] > 0;
                }
            }
            plumb_world_destroy(w);
        }
        print_message("paddles over balls, %s: not passed in %d looks\n", solver_name(solver),
                      swept);
        assert_true(swept > 300);
    }
}

// Where a kinematic paddle crushes a ball against a wall, the wall holds, however thin.
static void a_wall_holds_what_a_paddle_crushes(void **state)
{
    (void)state;
    for (int solver = 0; solver < 2; ++solver) {
        for (int k = 0; k < 12; ++k) {
            plumb_world *w = space(solver);
            plumb_material m = sim_material(w, 0.3, k % 2 * 0.5);
            plumb_body wall = sim_body(w, PLUMB_STATIC, 0, 0, 0);
            sim_add_box(w, wall, 0.002, 50, m);
            plumb_body paddle = sim_body(w, PLUMB_KINEMATIC, 5, 0, 0);
            sim_add_box(w, paddle, 0.1, 3, m);
            plumb_body ball = sim_ball(w, 1 + 0.2 * k, 0.1 * k, 0.15, m);
            sim_launch(w, paddle, -10 * pow(1.5, k), 0, 0);
            for (int step = 0; step < 60; ++step) {
                sim_step(w, HZ60);
                assert_true(sim_x(w, ball) > 0);
            }
            plumb_world_destroy(w);
        }
    }
}

static plumb_body bullet(plumb_world *w, double x, double y, double hx, double hy, plumb_material m,
                         double vx, double spin)
{
    plumb_body b = sim_crate(w, x, y, hx, hy, m);
    assert_int_equal(plumb_body_set_continuous(w, b, true), PLUMB_OK);
    sim_launch(w, b, vx, 0, spin);
    return b;
}

// Ten bodies in a row, every other one a bullet, at random speeds up to 1000 m/s towards each
// other, between two thin walls: their order stays.
static void bullets_keep_their_order(void **state)
{
    (void)state;
    unsigned seed = 17;
    for (int solver = 0; solver < 2; ++solver) {
        for (int run = 0; run < 30; ++run) {
            plumb_world *w = space(solver);
            plumb_material m = sim_material(w, 0, run % 3 * 0.5);
            for (int i = -1; i <= 1; i += 2) {
                plumb_body wall = sim_body(w, PLUMB_STATIC, i * 12, 0, 0);
                sim_add_box(w, wall, 0.001, 2, m);
                plumb_body rail = sim_body(w, PLUMB_STATIC, 0, i * 0.26, 0);
                sim_add_box(w, rail, 13, 0.01, m);
            }
            plumb_body b[10];
            for (int i = 0; i < 10; ++i) {
                double half = sim_uniform(&seed, 0.02, 0.2);
                b[i] =
                    bullet(w, 2.2 * (i - 4.5), 0, half, 0.2, m, sim_uniform(&seed, -1000, 1000), 0);
                plumb_body_set_continuous(w, b[i], i % 2 == 0);
                // A thin one that fell over could be passed beside.
                plumb_body_set_fixed_rotation(w, b[i], half < 0.14);
            }
            for (int step = 0; step < 120; ++step) {
                sim_step(w, HZ60);
                for (int i = 0; i < 10; ++i) {
                    double left = i > 0 ? sim_x(w, b[i - 1]) : -12;
                    assert_true(sim_x(w, b[i]) > left);
                    assert_true(sim_x(w, b[i]) < 12);
                }
            }
            plumb_world_destroy(w);
        }
    }
}

// Who asks matters between dynamic bodies, and only there: see plumb_body_desc.continuous.
static void only_those_that_ask_stop_at_dynamic_bodies(void **state)
{
    (void)state;
    // Two thin plates that spin through each other's place, side by side.
    for (int asks = 0; asks < 3; ++asks) {
        int passed = 0;
        for (int k = 0; k < 40; ++k) {
            plumb_world *w = space(0);
            plumb_material m = sim_material(w, 0, 0);
            plumb_body rod = sim_crate(w, 0, 0, ROD_HALF, ROD_HALF_W, m);
            plumb_body ball = sim_ball(w, 0.2 + 0.04 * k, 0.5, 0.05, m);
            plumb_body_set_mass(w, ball, 1000);
            plumb_body_set_continuous(w, asks == 1 ? rod : ball, asks > 0);
            sim_launch(w, rod, 0, 0, 40 + 9 * k);
            for (int step = 0; step < 5; ++step) {
                sim_step(w, HZ60);
                plumb_vec2 p =
                    plumb_body_local_point(w, rod, sim_vec(sim_x(w, ball), sim_y(w, ball)));
                if (hypot((double)p.x, (double)p.y) > ROD_HALF) {
                    break;
                }
                passed += !((double)p.y > 0);
            }
            plumb_world_destroy(w);
        }
        print_message("rod and ball, %s: passed in %d looks\n",
                      asks == 0   ? "neither asks"
                      : asks == 1 ? "the rod asks"
                                  : "the ball asks",
                      passed);
        assert_true(asks == 0 ? passed > 0 : passed == 0);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(kinematic_paddle_passes_no_ball),
        cmocka_unit_test(a_wall_holds_what_a_paddle_crushes),
        cmocka_unit_test(bullets_keep_their_order),
        cmocka_unit_test(only_those_that_ask_stop_at_dynamic_bodies),
    };
    return cmocka_run_group_tests_name("movers", tests, NULL, NULL);
}
