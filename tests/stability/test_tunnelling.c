// test_tunnelling.c - nothing passes through anything: shots at thin walls, spinning rods and posts,
// closed boxes, jointed bodies; and what may go on is not stopped. What moves itself: test_movers.c.
// Float and double, both solvers. `make shots` fires a hundred thousand more, beside Box2D.
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "harness/near.h"
#include "harness/shots.h"
#include "harness/trials.h"
#include "space.h"

// The classic solver, which takes one substep of its own accord, cannot hold a hinge whose body
// turns by a radian a substep: the rod would leave it and go around the post.
static plumb_world *hinged_space(int solver)
{
    return sim_world(&(plumb_world_desc){ .zero_gravity = true,
                                          .solver = (plumb_solver)solver,
                                          .substeps = solver == PLUMB_SOLVER_PGS ? 64 : 4 });
}

//---- shots ---------------------------------------------------------------------------------------

typedef struct volley {
    enum shot_wall wall;
    double thickness; // [m]
} volley;

static void no_shot_gets_through_a_wall(void **state)
{
    (void)state;
    const volley volleys[] = { { SHOT_BOXES, 0.001 }, { SHOT_BOXES, 0.003 }, { SHOT_BOXES, 0.01 },
                               { SHOT_BOXES, 0.03 },  { SHOT_BOXES, 0.1 },   { SHOT_SEGMENTS, 0 },
                               { SHOT_CHAIN, 0 } };
    const char *solvers[] = { "soft", "baseline" };
    for (int solver = 0; solver < 2; ++solver) {
        unsigned seed = 7;
        int fired = 0;
        double deepest = 0;
        for (size_t v = 0; v < sizeof volleys / sizeof volleys[0]; ++v) {
            for (int i = 0; i < 250; ++i) {
                struct shot shot = shot_random(&seed, volleys[v].wall, volleys[v].thickness,
                                               (enum shot_body)(i % SHOT_BODIES), 2000);
                struct engine_options o = engine_options_default();
                o.solver = solvers[solver];
                struct shot_result r = shot_fire(&engine_plumb, &o, &shot);
                deepest = fmax(deepest, r.deepest);
                assert_false(r.missed);
                ++fired;
            }
        }
        print_message("%d shots, %s: none through, %.3g m deep at most\n", fired, solvers[solver],
                      deepest);
        assert_true(deepest < 0.05);
    }
}

// The test above must be able to fail: without sweeps, some of its rods get through.
static void without_sweeps_shots_get_through(void **state)
{
    (void)state;
    unsigned seed = 7;
    int missed = 0;
    for (int i = 0; i < 100; ++i) {
        struct shot shot = shot_random(&seed, SHOT_BOXES, 0.01, SHOT_ROD, 2000);
        struct engine_options o = engine_options_default();
        o.continuous = false;
        missed += shot_fire(&engine_plumb, &o, &shot).missed;
    }
    print_message("without sweeps %d of 100 rods get through\n", missed);
    assert_true(missed >= 5);
}

// Tiny things, long steps, the corner cases of sizes.
static void tiny_bodies_and_long_steps(void **state)
{
    (void)state;
    unsigned seed = 11;
    for (int i = 0; i < 400; ++i) {
        struct shot shot = shot_random(&seed, i % 2 ? SHOT_SEGMENTS : SHOT_BOXES, 0.001,
                                       (enum shot_body)(i % SHOT_BODIES), 2000);
        shot.wall = i % 3 == 0 ? SHOT_CHAIN : shot.wall;
        shot.thickness = shot.wall == SHOT_BOXES ? shot.thickness : 0;
        if (i % 4 < 2) {
            shot.size = 0.001;
            shot.body = SHOT_CIRCLE;
        } else {
            shot.dt = 0.1;
            shot.speed = fmin(shot.speed, 300); // it must not reach the ends of the wall
        }
        struct engine_options o = engine_options_default();
        assert_false(shot_fire(&engine_plumb, &o, &shot).missed);
    }
}

//---- rods and posts ------------------------------------------------------------------------------

#define POST 0.025 // [m] half of its 5 cm

static void add_post(plumb_world *w, double x, double y, bool box, plumb_material m)
{
    plumb_body post = sim_body(w, PLUMB_STATIC, x, y, 0.3);
    if (box) {
        sim_add_box(w, post, POST, POST, m);
    } else {
        sim_add_circle(w, post, POST, m);
    }
}

static void hinge(plumb_world *w, plumb_body a, double x, double y)
{
    assert_false(plumb_is_null(plumb_joint_create(
        w, &(plumb_joint_desc){ .kind = PLUMB_REVOLUTE, .body_a = a, .anchor = sim_vec(x, y) })));
}

// How far the middle line of a rod is from the wrong side of either of two posts at (0, +-at). The
// hinge gives under the shock, so the rod's angle alone does not tell.
static double room_between(const plumb_world *w, plumb_body rod, double at)
{
    double room = INFINITY;
    for (int side = -1; side <= 1; side += 2) {
        plumb_vec2 post = plumb_body_local_point(w, rod, sim_vec(0, side * at));
        if (fabs((double)post.x) <= ROD_HALF) { // not beyond the rod's end
            room = fmin(room, side * (double)post.y);
        }
    }
    return room;
}

// A rod hinged at its end in the sector between two posts, spun at them. Whatever the number of
// turns that a step would make of it, it must be in that sector after every one.
static void hinged_rod_stays_between_posts(void **state)
{
    (void)state;
    const double speeds[] = { 1, 3, 10, 30, 60, 100, 200, 300, 500, 700, 1000 };
    for (int solver = 0; solver < 2; ++solver) {
        double least = INFINITY;
        int torn = 0;
        for (size_t i = 0; i < sizeof speeds / sizeof speeds[0]; ++i) {
            for (int k = 0; k < 24; ++k) {
                plumb_world *w = hinged_space(solver);
                plumb_material m = sim_material(w, 0.3, k % 3 * 0.5);
                double at = 0.7 + 0.14 * (k % 8); // [m] of the posts along the rod, up to 1.7 of 4
                at *= k % 2 ? 2 : 1;
                add_post(w, 0, at, k % 4 < 2, m);
                add_post(w, 0, -at, k % 4 < 2, m);
                plumb_body rod = sim_crate(w, ROD_HALF, 0, ROD_HALF, ROD_HALF_W, m);
                hinge(w, rod, 0, 0);
                double w0 = k % 2 ? speeds[i] : -speeds[i];
                sim_launch(w, rod, 0, w0 * ROD_HALF, w0);
                for (int step = 0; step < 60; ++step) {
                    sim_step(w, HZ60);
                    plumb_vec2 end = plumb_body_world_point(w, rod, sim_vec(-ROD_HALF, 0));
                    if (plumb_vec2_magnitude(end) > at) {
                        // The hinge gave by so much that the rod's end went round the post: only where
                        // the rod turns by more than 2.5 radians a substep, which no joint can follow,
                        // solved in lanes or alone. It is the first step that tears, not the post.
                        assert_true(speeds[i] * HZ60 / 4 > 2.5 && step == 0);
                        ++torn;
                        break;
                    }
                    double room = room_between(w, rod, at);
                    least = fmin(least, room);
                    if (!(room > 0)) {
                        print_message("%s, %g rad/s, posts at %g: %g m after step %d\n",
                                      solver_name(solver), w0, at, room, step);
                    }
                    assert_true(room > 0);
                }
                plumb_world_destroy(w);
            }
        }
        print_message("rods between posts, %s: middle at least %.4f m off; %d of 264 torn off\n",
                      solver_name(solver), least, torn);
        assert_true(torn <= 20);
    }
}

// A free rod beside a post: in the rod's frame the post may leave the side on which it is only
// beyond the rod's end.
static void free_rod_does_not_pass_a_post(void **state)
{
    (void)state;
    unsigned seed = 3;
    for (int solver = 0; solver < 2; ++solver) {
        int watched = 0;
        for (int i = 0; i < 1000; ++i) {
            plumb_world *w = space(solver);
            plumb_material m = sim_material(w, 0.3, i % 3 * 0.5);
            double spin = exp(sim_uniform(&seed, 0, log(1000)));
            double along = sim_uniform(&seed, -1.8, 1.8);
            add_post(w, along, 0.5, i % 2 == 0, m);
            plumb_body rod = sim_crate(w, 0, 0, ROD_HALF, ROD_HALF_W, m);
            sim_launch(w, rod, sim_uniform(&seed, -3, 3), sim_uniform(&seed, -3, 3),
                       i % 4 < 2 ? spin : -spin);
            for (int step = 0; step < 60; ++step) {
                sim_step(w, HZ60);
                plumb_vec2 p = plumb_body_local_point(w, rod, sim_vec(along, 0.5));
                // Beyond its reach it may go around the rod's end between two looks.
                if (hypot((double)p.x, (double)p.y) > ROD_HALF) {
                    break;
                }
                ++watched;
                assert_true((double)p.y > 0);
            }
            plumb_world_destroy(w);
        }
        print_message("free rods beside posts, %s: never passed in %d steps\n", solver_name(solver),
                      watched);
        assert_true(watched > 3000);
    }
}

// A motor that never tires presses the rod against a post.
static void driven_rod_does_not_pass_a_post(void **state)
{
    (void)state;
    const double speeds[] = { 1, 10, 100, 1000 }, torques[] = { 1, 100, 1e4 };
    for (int solver = 0; solver < 2; ++solver) {
        for (int i = 0; i < 12; ++i) {
            plumb_world *w = hinged_space(solver);
            plumb_material m = sim_material(w, 0.3, 0);
            add_post(w, 0, 1.5, false, m);
            add_post(w, 0, -1.5, false, m);
            plumb_body rod = sim_crate(w, ROD_HALF, 0, ROD_HALF, ROD_HALF_W, m);
            plumb_joint_create(w, &(plumb_joint_desc){ .kind = PLUMB_REVOLUTE,
                                                       .body_b = rod,
                                                       .enable_motor = true,
                                                       .motor_speed = (plumb_real)speeds[i % 4],
                                                       .max_motor = (plumb_real)torques[i / 4] });
            for (int step = 0; step < 120; ++step) {
                sim_step(w, HZ60);
                double room = room_between(w, rod, 1.5);
                if (!(room > 0)) {
                    print_message("%s, %g rad/s, %g N m: %g m after step %d\n", solver_name(solver),
                                  speeds[i % 4], torques[i / 4], room, step);
                }
                assert_true(room > 0);
            }
            plumb_world_destroy(w);
        }
    }
}

//---- closed boxes --------------------------------------------------------------------------------

typedef struct cell_case {
    double restitution;
    double speed;  // [m/s]
    bool segments; // lines, otherwise boxes of 1 mm
    bool gravity;
} cell_case;

static void balls_stay_in_a_closed_box(void **state)
{
    (void)state;
    const cell_case cases[] = { { 0.5, 100, false, true },
                                { 1, 100, false, false },
                                { 1, 500, true, false },
                                { 0.5, 1000, true, true },
                                { 0.9, 50, false, true } };
    for (int solver = 0; solver < 2; ++solver) {
        for (size_t k = 0; k < sizeof cases / sizeof cases[0]; ++k) {
            if (!trials_takes((uint32_t)k + 5 * (uint32_t)solver, 3)) {
                continue;
            }
            const cell_case *c = &cases[k];
            plumb_world *w = sim_world(
                &(plumb_world_desc){ .zero_gravity = !c->gravity, .solver = (plumb_solver)solver });
            plumb_material m = sim_material(w, 0, c->restitution);
            plumb_vec2 corner[4] = { sim_vec(-5, -5), sim_vec(5, -5), sim_vec(5, 5),
                                     sim_vec(-5, 5) };
            plumb_body cell = sim_body(w, PLUMB_STATIC, 0, 0, 0);
            for (int i = 0; i < 4; ++i) {
                if (c->segments) {
                    sim_add_segment(w, cell, corner[i], corner[(i + 1) % 4], m);
                } else {
                    plumb_body wall =
                        sim_body(w, PLUMB_STATIC, i % 2 ? 0 : i - 1.0, i % 2 ? i - 2.0 : 0, 0);
                    plumb_body_teleport(
                        w, wall, i % 2 ? sim_vec(0, 5.0 * (i - 2)) : sim_vec(5.0 * (i - 1), 0), 0);
                    sim_add_box(w, wall, i % 2 ? 5.001 : 0.0005, i % 2 ? 0.0005 : 5.001, m);
                }
            }
            unsigned seed = 21;
            plumb_body balls[50];
            for (int i = 0; i < 50; ++i) {
                balls[i] = sim_ball(w, i % 7 - 3.0, (i / 7) - 3.5, 0.15, m);
                double way = sim_uniform(&seed, -SIM_PI, SIM_PI);
                sim_launch(w, balls[i], c->speed * cos(way), c->speed * sin(way), 0);
            }
            double before = sim_energy(w), farthest = 0;
            for (int step = 0; step < 1200; ++step) {
                sim_step(w, HZ60);
                for (int i = 0; i < 50; ++i) {
                    double out = fmax(fabs(sim_x(w, balls[i])), fabs(sim_y(w, balls[i])));
                    farthest = fmax(farthest, out);
                    assert_true(out < 5);
                }
            }
            print_message(
                "50 balls, e = %g, %g m/s, %s: centres within %.3f of 4.85 m, energy %.4f\n",
                c->restitution, c->speed, solver_name(solver), farthest, sim_energy(w) / before);
            assert_true(sim_energy(w) <= before * 1.001);
            plumb_world_destroy(w);
        }
    }
}

//---- joints --------------------------------------------------------------------------------------

enum { LINKS = 12 };

// A chain of links thrown at a thin wall, side on and end on: nothing of it gets through, and its
// joints are whole again soon after.
static void thrown_chain_stays_whole(void **state)
{
    (void)state;
    const double speeds[] = { 20, 100, 500, 2000 };
    for (int solver = 0; solver < 2; ++solver) {
        for (int k = 0; k < 16; ++k) {
            plumb_world *w = space(solver);
            plumb_material m = sim_material(w, 0.3, 0);
            plumb_body wall = sim_body(w, PLUMB_STATIC, 0, 0, 0);
            sim_add_box(w, wall, 0.002, 200, m);
            double turned = k / 4 * 0.5;
            plumb_body link[LINKS];
            plumb_joint joint[LINKS];
            double c = cos(turned), s = sin(turned);
            for (int i = 0; i < LINKS; ++i) {
                double at = 0.4 * i;
                link[i] = sim_body(w, PLUMB_DYNAMIC, 2 + c * at, s * at, turned);
                // Links do not collide with one another: thrown so hard, they would be knotted.
                plumb_shape_create(w, link[i],
                                   &(plumb_shape_desc){ .kind = PLUMB_BOX,
                                                        .half = sim_vec(0.18, 0.03),
                                                        .filter = { .group = -1 },
                                                        .material = m });
                sim_launch(w, link[i], -speeds[k % 4], 0, 0);
                if (i > 0) {
                    joint[i] = plumb_joint_create(
                        w, &(plumb_joint_desc){ .kind = PLUMB_REVOLUTE,
                                                .body_a = link[i - 1],
                                                .body_b = link[i],
                                                .anchor =
                                                    sim_vec(2 + c * (at - 0.2), s * (at - 0.2)) });
                }
            }
            double worst = 0, last = 0;
            // Faster, links that strike askew turn by radians in a substep. No joint follows that, with
            // sweeps or without, and the chain may fly off round the wall's ends.
            if (k / 4 == 1 && speeds[k % 4] > 100) {
                plumb_world_destroy(w);
                continue;
            }
            for (int step = 0; step < 120; ++step) {
                sim_step(w, HZ60);
                last = 0;
                for (int i = 0; i < LINKS; ++i) {
                    assert_true(sim_x(w, link[i]) > 0);
                    if (i > 0) {
                        plumb_vec2 a = plumb_joint_anchor_a(w, joint[i]);
                        plumb_vec2 b = plumb_joint_anchor_b(w, joint[i]);
                        last = fmax(last, hypot((double)(b.x - a.x), (double)(b.y - a.y)));
                    }
                }
                worst = fmax(worst, last);
            }
            print_message(
                "chain at %g m/s, turned %.1f, %s: joints %.3f m apart at worst, %.2g after 2 s\n",
                speeds[k % 4], turned, solver_name(solver), worst, last);
            assert_true(last < 0.03);
            plumb_world_destroy(w);
        }
    }
}

//---- what may go on ------------------------------------------------------------------------------

// A box slides at 200 m/s over a floor of many boxes, or of segments; a ball rolls. What it does
// is the same without sweeps, to the last bit.
static void sliding_is_not_stopped(void **state)
{
    (void)state;
    for (int solver = 0; solver < 2; ++solver) {
        double reached[2] = { 0, 0 };
        for (int k = 0; k < 12; ++k) {
            plumb_world *w = sim_world(
                &(plumb_world_desc){ .solver = (plumb_solver)solver, .no_continuous = k % 2 == 1 });
            plumb_material m = sim_material(w, 0, 0);
            plumb_body floor = sim_body(w, PLUMB_STATIC, 0, 0, 0);
            for (int i = -5; i < 250; ++i) {
                plumb_vec2 p[4] = { sim_vec(2 * i, -1), sim_vec(2 * i + 2, -1),
                                    sim_vec(2 * i + 2, 0), sim_vec(2 * i, 0) };
                if (k < 6) {
                    plumb_shape_create(
                        w, floor,
                        &(plumb_shape_desc){
                            .kind = PLUMB_POLYGON, .points = p, .count = 4, .material = m });
                } else {
                    sim_add_segment(w, floor, p[2], p[3], m);
                }
            }
            bool box = k / 2 % 3 != 1;
            plumb_body b = box ? sim_crate(w, 0, 0.3, 0.5, 0.3, m) : sim_ball(w, 0, 0.3, 0.3, m);
            sim_run(w, 30, HZ60);
            sim_launch(w, b, 200, 0, box ? 0 : -200 / 0.3);
            uint32_t fast = 0, stopped = 0;
            for (int step = 0; step < 120; ++step) {
                sim_step(w, HZ60);
                fast += plumb_world_stats(w).fast_count;
                stopped += plumb_world_stats(w).stopped_count;
            }
            reached[k % 2] = sim_x(w, b);
            print_message("%s over %s, %s: %.4f m in 2 s, swept %u times, stopped %u times\n",
                          box ? "box" : "ball", k < 6 ? "boxes" : "segments", solver_name(solver),
                          sim_x(w, b), (unsigned)fast, (unsigned)stopped);
            assert_int_equal(stopped, 0);
            if (k % 2 == 1) {
                assert_int_equal(fast, 0);
                assert_true(reached[0] <= reached[1] && reached[0] >= reached[1]);
            } else {
                assert_true(fast > 60);
            }
            plumb_world_destroy(w);
        }
    }
}

// A rod spins a centimetre clear of a post.
static void spinning_beside_a_post_is_not_stopped(void **state)
{
    (void)state;
    for (int solver = 0; solver < 2; ++solver) {
        plumb_world *w = space(solver);
        plumb_material m = sim_material(w, 0, 0);
        add_post(w, 0, ROD_HALF + POST + 0.01, false, m);
        plumb_body rod = sim_crate(w, 0, 0, ROD_HALF, ROD_HALF_W, m);
        sim_launch(w, rod, 0, 0, 1000);
        for (int step = 0; step < 60; ++step) {
            sim_step(w, HZ60);
            assert_int_equal(plumb_world_stats(w).stopped_count, 0);
        }
        assert_near(sim_w(w, rod), 1000, ROUNDED(1e-3));
        plumb_world_destroy(w);
    }
}

// A teleport is no motion; a body made inside a wall has no side and is left to the contact.
static void teleports_and_bodies_made_inside(void **state)
{
    (void)state;
    plumb_world *w = space(0);
    plumb_material m = sim_material(w, 0, 0);
    plumb_body wall = sim_body(w, PLUMB_STATIC, 0, 0, 0);
    sim_add_box(w, wall, 0.05, 20, m);
    plumb_body through = sim_ball(w, -2, 0, 0.1, m);
    plumb_body inside = sim_ball(w, 0.001, 5, 0.1, m);
    sim_step(w, HZ60);
    assert_int_equal(plumb_body_teleport(w, through, sim_vec(2, 0), 0), PLUMB_OK);
    sim_launch(w, inside, 100, 0, 0);
    sim_run(w, 10, HZ60);
    assert_true(sim_x(w, through) > 1.99);
    assert_true(sim_x(w, inside) > 1); // out, to the side to which it went
    plumb_world_destroy(w);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(no_shot_gets_through_a_wall),
        cmocka_unit_test(without_sweeps_shots_get_through),
        cmocka_unit_test(tiny_bodies_and_long_steps),
        cmocka_unit_test(hinged_rod_stays_between_posts),
        cmocka_unit_test(free_rod_does_not_pass_a_post),
        cmocka_unit_test(driven_rod_does_not_pass_a_post),
        cmocka_unit_test(balls_stay_in_a_closed_box),
        cmocka_unit_test(thrown_chain_stays_whole),
        cmocka_unit_test(sliding_is_not_stopped),
        cmocka_unit_test(spinning_beside_a_post_is_not_stopped),
        cmocka_unit_test(teleports_and_bodies_made_inside),
    };
    return cmocka_run_group_tests_name("tunnelling", tests, NULL, NULL);
}
