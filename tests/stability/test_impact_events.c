// test_impact_events.c - every impact is told once, and nothing else is: begin, end and hit events, breaking joints
// and sensors, judged by an observer who knows of velocities and poses alone (impact_throw.h).
#include <math.h>
#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <stdint.h>
#include <stdio.h>

#include <cmocka.h>

#include "harness/sim.h"
#include "harness/trials.h"
#include "impact_gap.h"
#include "impact_throw.h"

static int lines;

static void tell(const char *line)
{
    if (lines++ < 40) {
        print_message("%s\n", line);
    }
}

static void every_impact_is_told_once(void **state)
{
    (void)state;
    const trials throws = trials_from(1, 4000);
    impact_tally t = { 0 };
    for (uint32_t i = throws.first; i < throws.end; ++i) {
        impact_throw(i, &t, tell);
    }
    print_message("%ld thrown, %ld touches, %ld hits: missed %ld, phantom %ld, doubled %ld, "
                  "lingering %ld, mute %ld, "
                  "false hits %ld, askew %ld\n",
                  t.thrown, t.touches, t.hits, t.missed, t.phantom, t.doubled, t.lingering, t.mute,
                  t.false_hits, t.askew);
    assert_true(t.touches > t.thrown / 3);
    assert_int_equal(impact_wrong(&t), 0);
}

// The first settings of 1,000 boxes that a wall stops: defaults, no force that presses them there.
static void wall_is_hit_by_all(plumb_solver solver)
{
    plumb_world *w =
        sim_world(&(plumb_world_desc){ .zero_gravity = true, .solver = solver, .hit_speed = 1 });
    plumb_material m = sim_material(w, 0, 0);
    plumb_body wall = sim_body(w, PLUMB_STATIC, 0.5, 0, 0);
    sim_add_box(w, wall, 0.5, 2000, m);
    uint32_t seed = 5;
    for (int i = 0; i < 1000; ++i) {
        plumb_body b = sim_crate(w, -sim_uniform(&seed, 2, 6), 2 * (i - 500), 0.5, 0.5, m);
        sim_launch(w, b, sim_uniform(&seed, 20, 60), 0, 0);
    }
    int begins = 0, ends = 0, hits = 0, count;
    for (int step = 0; step < 60; ++step) {
        sim_step(w, 1.0 / 60);
        plumb_world_begin_events(w, &count);
        begins += count;
        plumb_world_end_events(w, &count);
        ends += count;
        plumb_world_hit_events(w, &count);
        hits += count;
    }
    assert_int_equal(begins, 1000);
    assert_int_equal(ends, 0);
    assert_int_equal(hits, 1000);
    plumb_world_destroy(w);
}

static void a_wall_is_hit_by_all(void **state)
{
    (void)state;
    for (int solver = PLUMB_SOLVER_SOFT; solver <= PLUMB_SOLVER_EXACT; ++solver) {
        wall_is_hit_by_all((plumb_solver)solver);
    }
}

// A ball strikes a box that a weld holds. What the weld bore over the step is what the two bodies have lost; it
// breaks by more than it can bear, in whichever substep the ball came, and by nothing less.
static void joints_break_by_what_they_bore(void **state)
{
    (void)state;
    uint32_t seed = 3;
    int broken = 0, whole = 0;
    for (int i = 0; i < 600; ++i) {
        const double dt = 1.0 / 60, speed = sim_uniform(&seed, 2, 100);
        const bool by_force = i % 2 == 0;
        plumb_world *w = sim_world(&(plumb_world_desc){
            .zero_gravity = true, .solver = (plumb_solver)(i % 3), .substeps = 1 + i % 8 });
        plumb_material m = sim_material(w, 0, i % 5 == 0 ? sim_uniform(&seed, 0.1, 1) : 0);
        plumb_body box = sim_crate(w, 0, 0, 0.5, 0.5, m);
        plumb_body ball = sim_ball(w, -1 - speed * dt * sim_uniform(&seed, 0.05, 2.5), 0, 0.5, m);
        sim_launch(w, ball, speed, 0, 0);
        const double bound = (double)plumb_body_mass(w, ball) * speed * sim_uniform(&seed, 0.1, 2);
        plumb_joint joint = plumb_joint_create(
            w, &(plumb_joint_desc){ .kind = PLUMB_WELD,
                                    .body_b = box,
                                    .break_force = (plumb_real)(by_force ? bound / dt : 0),
                                    .break_impulse = (plumb_real)(by_force ? 0 : bound) });
        for (int step = 0; step < 6 && plumb_joint_valid(w, joint); ++step) {
            const double before = sim_vx(w, ball) * (double)plumb_body_mass(w, ball) +
                                  sim_vx(w, box) * (double)plumb_body_mass(w, box);
            sim_step(w, dt);
            const double after = sim_vx(w, ball) * (double)plumb_body_mass(w, ball) +
                                 sim_vx(w, box) * (double)plumb_body_mass(w, box);
            const double bore = fabs(after - before);
            if (fabs(bore - bound) > 0.02 * bound + 1e-4 * speed) {
                assert_int_equal(plumb_joint_valid(w, joint), bore < bound);
                broken += bore > bound;
                whole += bore < bound && bore > 0.1 * bound;
            }
        }
        plumb_world_destroy(w);
    }
    print_message("%d joints broken, %d blows borne\n", broken, whole);
    assert_true(broken > 100 && whole > 100);
}

// What flies through a sensor, or into it and bounces off what is behind, is told as often as its pose says.
static void sensors_tell_what_poses_say(void **state)
{
    (void)state;
    uint32_t seed = 9;
    int begins = 0, ends = 0, wrong = 0;
    for (int i = 0; i < 1500; ++i) {
        const double dt = 1.0 / (30 << i % 4), speed = sim_uniform(&seed, 1, 60),
                     turn = sim_uniform(&seed, -3, 3);
        plumb_world *w = sim_world(&(plumb_world_desc){ .zero_gravity = true,
                                                        .solver = (plumb_solver)(i % 3),
                                                        .substeps = 1 + i % 8,
                                                        .no_sleep = true });
        plumb_material m = sim_material(w, 0, sim_uniform(&seed, 0, 1));
        plumb_body post = sim_body(w, PLUMB_STATIC, 3, 0, turn);
        plumb_shape sensor = plumb_shape_create(
            w, post,
            &(plumb_shape_desc){
                .kind = PLUMB_BOX, .half = { 1, (plumb_real)(0.7) }, .sensor = true });
        plumb_body wall = sim_body(w, PLUMB_STATIC, 6, 0, sim_uniform(&seed, -1, 1));
        sim_add_box(w, wall, 0.2, 5, m);
        plumb_body ball = plumb_body_create(
            w, &(plumb_body_desc){ .position = sim_vec(0, sim_uniform(&seed, -1, 1)) });
        plumb_shape shape =
            plumb_shape_create(w, ball,
                               &(plumb_shape_desc){ .kind = i % 2 == 0 ? PLUMB_CIRCLE : PLUMB_BOX,
                                                    .radius = (plumb_real)(0.1),
                                                    .half = { i % 2 == 0 ? 0 : (plumb_real)(0.3),
                                                              i % 2 == 0 ? 0 : (plumb_real)(0.1) },
                                                    .material = m });
        sim_launch(w, ball, speed, 0, sim_uniform(&seed, -5, 5));
        bool inside = false;
        double last = 1; // [m]
        for (int step = 0; step < 40; ++step) {
            sim_step(w, dt);
            int began, ended;
            plumb_world_sensor_begin_events(w, &began);
            plumb_world_sensor_end_events(w, &ended);
            const double gap = impact_gap(w, sensor, shape);
            wrong += (began > 0 && inside) || (ended > 0 && !inside) || began + ended > 1;
            inside = began > 0 || (inside && ended == 0);
            wrong += gap == 0 && !inside && last == 0;
            wrong += gap > 1e-4 && inside;
            begins += began, ends += ended;
            last = gap;
        }
        plumb_world_destroy(w);
    }
    print_message("%d begins, %d ends at sensors, %d wrong\n", begins, ends, wrong);
    assert_true(begins > 500);
    assert_int_equal(wrong, 0);
}

// A plank turns on a round post, on one point, and is struck within the step, so that it spins. Nothing there is faster than
// the ball makes its far end: no hit is told, and nothing moves, as if the point that it does not have had struck it.
static void what_spins_on_one_point_is_struck_by_nothing_else(void **state)
{
    (void)state;
    uint32_t seed = 11;
    int hits = 0, wrong = 0;
    double fastest = 0;
    for (int i = 0; i < 1000; ++i) {
        const double dt = 1.0 / 60, half = sim_uniform(&seed, 0.1, 0.4),
                     spin = sim_uniform(&seed, 1, 10), speed = sim_uniform(&seed, 20, 60);
        plumb_world *w =
            sim_world(&(plumb_world_desc){ .zero_gravity = true, .hit_speed = (plumb_real)(0.5) });
        plumb_material m = sim_material(w, 0.6, 0);
        sim_add_circle(w, sim_body(w, PLUMB_STATIC, 0, 0, 0), 0.1, m);
        plumb_body plank = sim_crate(w, 0, 0.1199, half, 0.02, m);
        plumb_body_set_angular_velocity(w, plank, (plumb_real)spin);
        plumb_body ball =
            sim_ball(w, -0.9 * half, 0.24 + speed * dt * sim_uniform(&seed, 0.1, 0.6), 0.1, m);
        plumb_body_set_mass(w, ball, 1);
        sim_launch(w, ball, 0, -speed, 0);
        for (int step = 0; step < 3; ++step) {
            int count;
            sim_step(w, dt);
            const plumb_contact_hit *hit = plumb_world_hit_events(w, &count);
            for (int k = 0; k < count; ++k) {
                const double told = (double)hit[k].approach_speed;
                fastest = told > fastest ? told : fastest;
                wrong += told > 3 * speed;
            }
            hits += count;
        }
        plumb_world_destroy(w);
    }
    print_message("%d hits, the fastest at %g m/s, %d too fast\n", hits, fastest, wrong);
    assert_true(hits > 1000);
    assert_int_equal(wrong, 0);
}

// A polygon, or an outline of two pieces, falls on a chain.
static void drop_on_chain(plumb_world *w, uint32_t *seed, bool outline, plumb_material m)
{
    static const double wide[][2] = { { 0, 0 },     { 0.8, 0 },   { 0.8, 0.3 },
                                      { 0.3, 0.3 }, { 0.3, 0.9 }, { 0, 0.9 } };
    plumb_vec2 points[6];
    const int count = outline ? 6 : 5;
    for (int i = 0; i < count; ++i) {
        points[i] = outline ? sim_vec(wide[i][0], wide[i][1])
                            : sim_vec(0.4 * cos(6.283 * i / 5), 0.4 * sin(6.283 * i / 5));
    }
    plumb_body b = sim_body(w, PLUMB_DYNAMIC, sim_uniform(seed, -15, 15), sim_uniform(seed, 2, 12),
                            sim_uniform(seed, -3, 3));
    plumb_shape_create(w, b,
                       &(plumb_shape_desc){ .kind = outline ? PLUMB_OUTLINE : PLUMB_POLYGON,
                                            .points = points,
                                            .count = count,
                                            .material = m });
    plumb_body_set_break_impulse(w, b, (plumb_real)(sim_uniform(seed, 0, 1) < 0.2 ? 3 : 0));
}

// Of a pair of shapes a step tells one hit, at a moment of its own or of the step before: what was kept of a blow on one
// link of a chain, or on a body before it broke, is no second one.
static void a_step_tells_one_hit_a_pair(void **state)
{
    (void)state;
    uint32_t seed = 21;
    int hits = 0, twice = 0, when = 0;
    for (int run = 0; run < 12; ++run) {
        const double dt = run % 2 == 0 ? 1.0 / 60 : 1.0 / 30;
        plumb_world *w = sim_world(&(plumb_world_desc){ .hit_speed = (plumb_real)(0.5) });
        plumb_material m = sim_material(w, 0.6, run % 3 == 0 ? 0.4 : 0);
        plumb_vec2 hill[60];
        for (int i = 0; i < 60; ++i) {
            hill[i] = sim_vec(20 - i * 40 / 59.0, sim_uniform(&seed, -0.4, 0.4));
        }
        plumb_shape_create(w, sim_body(w, PLUMB_STATIC, 0, 0, 0),
                           &(plumb_shape_desc){ .kind = PLUMB_CHAIN, .points = hill, .count = 60 });
        for (int i = 0; i < 60; ++i) {
            drop_on_chain(w, &seed, i % 2 == 0, m);
        }
        for (int step = 0; step < 240; ++step) {
            int count;
            sim_step(w, dt);
            const plumb_contact_hit *hit = plumb_world_hit_events(w, &count);
            for (int k = 0; k < count; ++k) {
                when += (double)hit[k].moment > 1.0001 * dt || (double)hit[k].moment < -1.0001 * dt;
                for (int other = 0; other < k; ++other) {
                    twice += (plumb_same(hit[k].shape_a, hit[other].shape_a) &&
                              plumb_same(hit[k].shape_b, hit[other].shape_b)) ||
                             (plumb_same(hit[k].shape_a, hit[other].shape_b) &&
                              plumb_same(hit[k].shape_b, hit[other].shape_a));
                }
            }
            hits += count;
        }
        plumb_world_destroy(w);
    }
    print_message("%d hits, %d twice in a step, %d out of their step\n", hits, twice, when);
    assert_true(hits > 3000);
    assert_int_equal(twice, 0);
    assert_int_equal(when, 0);
}

// A body of several boxes that falls flat, without restitution: each is told by the speed of the fall, whatever those before it
// in the solver's order have made of it by then. What lands a substep later may have been turned: a seventh more.
static void fall_flat(uint32_t number, plumb_solver solver)
{
    uint32_t seed = number * 77 + 5;
    plumb_world *w = sim_world(&(plumb_world_desc){ .solver = solver, .hit_speed = 1 });
    const plumb_material m = sim_material(w, sim_uniform(&seed, 0, 1), 0);
    sim_floor(w, m);
    plumb_body b = sim_body(w, PLUMB_DYNAMIC, 0, 2, 0);
    const int boxes = 2 + (int)(sim_random(&seed) % 4);
    for (int i = 0; i < boxes; ++i) {
        plumb_shape_create(w, b,
                           &(plumb_shape_desc){ .kind = PLUMB_BOX,
                                                .half = sim_vec(0.15, 0.3),
                                                .center = sim_vec(-1 + 2.0 * i / (boxes - 1), 0),
                                                .material = m });
    }
    const double start = sim_uniform(&seed, 2, 8);
    sim_launch(w, b, sim_uniform(&seed, -2, 2), -start, 0);
    const double speed = sqrt(start * start + 2 * SIM_G * 1.7);
    int count = 0;
    for (int step = 0; step < 90 && count == 0; ++step) {
        sim_step(w, 1.0 / 60);
        const plumb_contact_hit *hits = plumb_world_hit_events(w, &count);
        for (int i = 0; i < count; ++i) {
            const double told = (double)hits[i].approach_speed / speed;
            if (!(told > 0.97 && told < 1.15)) {
                fail_msg("case %u: told %g of the speed of the fall", (unsigned)number, told);
            }
        }
    }
    assert_true(count > 0);
    plumb_world_destroy(w);
}

static void what_falls_flat_is_told_by_its_speed(void **state)
{
    (void)state;
    const trials t = trials_from(0, 200);
    for (uint32_t i = t.first; i < t.end; ++i) {
        fall_flat(i, PLUMB_SOLVER_SOFT);
        fall_flat(i, PLUMB_SOLVER_PGS);
        fall_flat(i, PLUMB_SOLVER_EXACT);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_impact_is_told_once),
        cmocka_unit_test(a_wall_is_hit_by_all),
        cmocka_unit_test(joints_break_by_what_they_bore),
        cmocka_unit_test(sensors_tell_what_poses_say),
        cmocka_unit_test(a_step_tells_one_hit_a_pair),
        cmocka_unit_test(what_spins_on_one_point_is_struck_by_nothing_else),
        cmocka_unit_test(what_falls_flat_is_told_by_its_speed),
    };
    return cmocka_run_group_tests_name("impact_events", tests, NULL, NULL);
}
