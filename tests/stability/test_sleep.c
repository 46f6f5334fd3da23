// test_sleep.c - piles fall asleep in reasonable time, what is slow and not at rest does not, and
// waking loses neither contact nor momentum.
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

#include "harness/near.h"
#include "harness/sim.h"

#define HZ60 (1 / 60.0)
#define MOST 256

//---- piles that come to rest ---------------------------------------------------------------------

static int build_stack(plumb_world *w, plumb_body *b, plumb_material m)
{
    for (int i = 0; i < 10; ++i) {
        b[i] = sim_crate(w, 0, 0.5 + i, 0.5, 0.5, m);
    }
    return 10;
}

static int build_pyramid(plumb_world *w, plumb_body *b, plumb_material m)
{
    int n = 0;
    for (int row = 0; row < 20; ++row) {
        for (int i = 0; i < 20 - row; ++i) {
            b[n++] = sim_crate(w, -10 + 0.5 * row + i, 0.5 + row, 0.5, 0.5, m);
        }
    }
    return n;
}

// Boxes and discs dropped into a trough, as they come.
// Of 60 heaps two twitch for ever (seeds 11 and 38; other ones whenever last digits change).
static int build_heap(plumb_world *w, plumb_body *b, plumb_material m)
{
    unsigned seed = 5;
    plumb_body walls = sim_body(w, PLUMB_STATIC, 0, 0, 0);
    sim_add_segment(w, walls, sim_vec(-3, 0), sim_vec(-5, 9), m);
    sim_add_segment(w, walls, sim_vec(3, 0), sim_vec(5, 9), m);
    for (int i = 0; i < 60; ++i) {
        double x = sim_uniform(&seed, -2, 2), y = 1 + 0.4 * i;
        double r = sim_uniform(&seed, 0.2, 0.4);
        b[i] = i % 2 == 0 ? sim_ball(w, x, y, r, m) : sim_crate(w, x, y, r, r, m);
    }
    return 60;
}

typedef struct pile {
    const char *name;
    int (*build)(plumb_world *w, plumb_body *b, plumb_material m);
    plumb_solver solver;
    double dt;    // [s]
    double limit; // [s] all sleep by then
} pile;

static double time_to_sleep(plumb_world *w, double dt, double limit)
{
    while (plumb_world_stats(w).dynamic_count > 0 && plumb_world_stats(w).time < limit) {
        sim_step(w, dt);
    }
    return plumb_world_stats(w).time;
}

static void piles_fall_asleep(void **state)
{
    (void)state;
    const pile piles[] = {
        { "stack of 10, 60 Hz", build_stack, PLUMB_SOLVER_SOFT, 1 / 60.0, 4 },
        { "stack of 10, 30 Hz", build_stack, PLUMB_SOLVER_SOFT, 1 / 30.0, 8 },
        { "stack of 10, 240 Hz", build_stack, PLUMB_SOLVER_SOFT, 1 / 240.0, 4 },
        { "pyramid of 20, 60 Hz", build_pyramid, PLUMB_SOLVER_SOFT, 1 / 60.0, 8 },
        { "pyramid of 20, 120 Hz", build_pyramid, PLUMB_SOLVER_SOFT, 1 / 120.0, 8 },
        { "heap of 60, 60 Hz", build_heap, PLUMB_SOLVER_SOFT, 1 / 60.0, 20 },
        { "heap of 60, 60 Hz, classic", build_heap, PLUMB_SOLVER_PGS, 1 / 60.0, 30 },
    };
    for (size_t i = 0; i < sizeof piles / sizeof piles[0]; ++i) {
        plumb_body b[MOST];
        plumb_world *w = sim_world(&(plumb_world_desc){ .solver = piles[i].solver });
        plumb_material m = sim_material(w, 0.6, 0);
        sim_floor(w, m);
        int n = piles[i].build(w, b, m);
        double t = time_to_sleep(w, piles[i].dt, piles[i].limit);
        plumb_stats s = plumb_world_stats(w);
        print_message("%-28s %3d bodies asleep after %5.2f s in %u islands, overlap %.2g m\n",
                      piles[i].name, n, t, s.island_count, (double)s.max_penetration);
        assert_true(t < piles[i].limit);
        assert_int_equal(s.asleep_count, n);
        plumb_world_destroy(w);
    }
}

//---- what is slow, and not at rest ---------------------------------------------------------------

// 100 m long, 1 m to the side: at the turning point slower than the threshold for a second.
static plumb_body hang_pendulum(plumb_world *w, double length, double aside)
{
    plumb_body bob = sim_ball(w, aside, -length, 0.5, sim_material(w, 0, 0));
    const plumb_joint_desc rod = { .kind = PLUMB_DISTANCE,
                                   .body_b = bob,
                                   .anchor_b = plumb_body_position(w, bob) };
    assert_false(plumb_is_null(plumb_joint_create(w, &rod)));
    return bob;
}

static void turning_points_are_no_rest(void **state)
{
    (void)state;
    const double lengths[] = { 1, 10, 100 };
    for (int i = 0; i < 3; ++i) {
        plumb_world *w = sim_world(&(plumb_world_desc){ 0 });
        double aside = lengths[i] / 50; // [m] 0.02 rad: fastest 0.063, 0.2, 0.63 m/s
        plumb_body bob = hang_pendulum(w, lengths[i], aside);
        double period = 2 * SIM_PI * sqrt(lengths[i] / SIM_G), slow = 0;
        for (double t = 0; t < 3 * period; t += HZ60) {
            sim_step(w, HZ60);
            slow += hypot(sim_vx(w, bob), sim_vy(w, bob)) < 0.05 ? HZ60 : 0;
            assert_true(plumb_body_is_awake(w, bob));
        }
        print_message("pendulum of %g m: slower than 5 cm/s for %.1f of %.1f s, awake\n",
                      lengths[i], slow, 3 * period);
        assert_true(lengths[i] < 100 || slow > 3);
        plumb_world_destroy(w);
    }
}

// A body thrown up in weak gravity, and one that begins to slide.
static void what_accelerates_slowly_is_no_rest(void **state)
{
    (void)state;
    plumb_world *w = sim_world(&(plumb_world_desc){ .gravity = { 0, (plumb_real)-0.05 } });
    plumb_body ball = sim_ball(w, 0, 0, 0.5, sim_material(w, 0, 0));
    sim_launch(w, ball, 0, 0.2, 0);
    sim_run(w, 60 * 10, HZ60);
    assert_near(sim_y(w, ball), 0.2 * 10 - 0.05 * 50, ROUNDED(1e-3));
    plumb_world_destroy(w);

    w = sim_world(&(plumb_world_desc){ 0 });
    double angle = 0.3, mu = tan(angle) - 0.001 / cos(angle); // 9.81 mm/s^2
    plumb_material m = sim_material(w, mu, 0);
    plumb_body ramp = sim_body(w, PLUMB_STATIC, -sin(angle), -cos(angle), -angle);
    sim_add_box(w, ramp, 50, 1, m);
    plumb_body block = sim_body(w, PLUMB_DYNAMIC, 0.25 * sin(angle), 0.25 * cos(angle), -angle);
    sim_add_box(w, block, 0.5, 0.25, m);
    sim_run(w, 60 * 10, HZ60);
    double way = hypot(sim_x(w, block) - 0.25 * sin(angle), sim_y(w, block) - 0.25 * cos(angle));
    print_message("block on a slope, 9.81 mm/s^2: %.3f m in 10 s\n", way);
    assert_near(way, 0.5 * SIM_G * 0.001 * 100, 0.05);
    plumb_world_destroy(w);
}

// Sliding and rolling faster than the threshold; slower is rest.
static void motion_above_the_threshold_goes_on(void **state)
{
    (void)state;
    const double speeds[] = { 0.06, 0.04 };
    for (int i = 0; i < 2; ++i) {
        plumb_world *w = sim_world(&(plumb_world_desc){ 0 });
        plumb_material ice = sim_material(w, 0, 0), wood = sim_material(w, 0.6, 0);
        sim_floor(w, ice);
        plumb_body slider = sim_crate(w, 0, 0.5, 0.5, 0.5, ice);
        plumb_body shelf = sim_body(w, PLUMB_STATIC, 0, 10, 0);
        sim_add_box(w, shelf, 20, 1, wood);
        plumb_body roller = sim_ball(w, 0, 11.5, 0.5, wood);
        sim_launch(w, slider, speeds[i], 0, 0);
        sim_launch(w, roller, speeds[i] * 0.7, 0, -speeds[i] * 1.4);
        sim_run(w, 60 * 10, HZ60);
        bool goes = i == 0;
        assert_int_equal(plumb_body_is_awake(w, slider), goes);
        assert_int_equal(plumb_body_is_awake(w, roller), goes);
        assert_true(!goes || fabs(sim_x(w, slider) - speeds[i] * 10) < 0.01);
        plumb_world_destroy(w);
    }
}

// What touches nothing fixed goes on, however slowly; a wall that it passes at a distance does not hold it.
static void what_floats_drifts(void **state)
{
    (void)state;
    const double speeds[] = { 0.04, 0.001 };
    for (int i = 0; i < 2; ++i) {
        const double v = speeds[i];
        plumb_world *w = sim_space();
        plumb_material ice = sim_material(w, 0, 0);
        plumb_body wall = sim_body(w, PLUMB_STATIC, 0, -1.51, 0);
        sim_add_box(w, wall, 20, 1, ice);
        plumb_body puck = sim_ball(w, 0, 0, 0.5, ice), pair[2], top = sim_ball(w, 10, 20, 0.5, ice);
        plumb_body still = sim_ball(w, 20, 20, 0.5, ice);
        for (int k = 0; k < 2; ++k) { // side by side
            pair[k] = sim_ball(w, k, 10, 0.5, ice);
            sim_launch(w, pair[k], 0, v, 0);
        }
        sim_launch(w, puck, v, 0, 0);
        sim_launch(w, top, 0, 0, v);
        sim_run(w, 60 * 10, HZ60);
        assert_near(sim_x(w, puck), 10 * v, 1e-5);
        assert_near(sim_y(w, pair[0]), 10 + 10 * v, 1e-5);
        assert_near(sim_y(w, pair[1]), 10 + 10 * v, 1e-5);
        assert_near(sim_angle(w, top), 10 * v, 1e-5);
        assert_false(plumb_body_is_awake(w, still));
        plumb_world_destroy(w);
    }
}

// On a kinematic body that turns, or moves: awake. On one that stands: asleep, and awake with it.
static void moving_ground_keeps_awake(void **state)
{
    (void)state;
    plumb_world *w = sim_world(&(plumb_world_desc){ 0 });
    plumb_material m = sim_material(w, 0.6, 0);
    plumb_body lift = sim_body(w, PLUMB_KINEMATIC, 0, 0, 0);
    sim_add_box(w, lift, 2, 0.5, m);
    plumb_body crate = sim_crate(w, 0, 1, 0.5, 0.5, m);
    sim_launch(w, lift, 0, 0.01, 0);
    sim_run(w, 300, HZ60);
    assert_true(plumb_body_is_awake(w, crate));
    assert_near(sim_y(w, crate), 1.05, 5e-3);
    sim_launch(w, lift, 0, 0, 0);
    sim_run(w, 120, HZ60);
    assert_false(plumb_body_is_awake(w, crate));
    sim_launch(w, lift, 0, 1, 0);
    sim_run(w, 60, HZ60);
    assert_true(plumb_body_is_awake(w, crate));
    assert_near(sim_y(w, crate) - sim_y(w, lift), 1, 5e-3);
    plumb_world_destroy(w);
}

//---- what is driven slowly --------------------------------------------------------------------------

#define SLOW 0.03 // [m/s], [rad/s] below sleep_speed

typedef struct machine {
    plumb_world *w;
    plumb_material belt;
    plumb_joint motor;
    plumb_body part; // that goes slowly
} machine;

static machine by_motor(plumb_joint_kind kind, double axis_y)
{
    machine m;
    memset(&m, 0, sizeof m);
    m.w = sim_world(&(plumb_world_desc){ 0 });
    m.part = sim_crate(m.w, 0, 5, 0.5, 0.5, sim_material(m.w, 0.6, 0));
    const plumb_joint_desc desc = { .kind = kind,
                                    .body_b = m.part,
                                    .anchor = sim_vec(0, 5),
                                    .axis = sim_vec(0, axis_y),
                                    .enable_motor = true,
                                    .motor_speed = (plumb_real)SLOW,
                                    .max_motor = 100 };
    m.motor = plumb_joint_create(m.w, &desc);
    return m;
}

static machine by_belt(bool rolls, bool below)
{
    machine m;
    memset(&m, 0, sizeof m);
    m.w = sim_world(&(plumb_world_desc){ 0 });
    const plumb_material_desc belt = { .surface_speed = (plumb_real)SLOW };
    m.belt = plumb_material_create(m.w, &belt);
    plumb_material plain = sim_material(m.w, 0.6, 0);
    sim_floor(m.w, below ? m.belt : plain);
    m.part = rolls ? sim_ball(m.w, 0, 0.5, 0.5, plain)
                   : sim_crate(m.w, 0, 0.5, 0.5, 0.5, below ? plain : m.belt);
    return m;
}

static double gone(const machine *m)
{
    return plumb_is_null(m->motor) ? sim_x(m->w, m->part)
                                   : (double)plumb_joint_value(m->w, m->motor);
}

// A motor and a belt go on, however slowly, and what they move sleeps when they stand.
static void what_is_driven_slowly_goes_on(void **state)
{
    (void)state;
    machine all[] = { by_motor(PLUMB_REVOLUTE, 0), by_motor(PLUMB_PRISMATIC, 1),
                      by_belt(false, true), by_belt(false, false), by_belt(true, true) };
    const double share[] = { 1, 1, 1, 1, 1.0 / 3 }; // a solid disc rolls, at a third of the speed
    for (int i = 0; i < 5; ++i) {
        machine *m = &all[i];
        sim_run(m->w, 600, HZ60);
        assert_near(gone(m) - SLOW * 10 * share[i], 0, 0.01);
        assert_true(plumb_body_is_awake(m->w, m->part));
        if (plumb_is_null(m->motor)) {
            plumb_material_set(m->w, m->belt, &(plumb_material_desc){ 0 });
        } else { // it runs against a stop
            const plumb_real stop = (plumb_real)gone(m);
            plumb_joint_set_limit(m->w, m->motor, true, -1, stop);
        }
        sim_run(m->w, 300, HZ60);
        assert_false(plumb_body_is_awake(m->w, m->part));
        assert_near(gone(m) - SLOW * 10 * share[i], 0, 0.02);
        plumb_world_destroy(m->w);
    }
}

// What errors that are undone move has no velocity of its own, and moves all the same.
static void corrections_are_motion(void **state)
{
    (void)state;
    for (int i = 0; i < 2; ++i) {
        plumb_world *w = sim_world(&(plumb_world_desc){ .push_speed = (plumb_real)0.1 });
        plumb_material m = sim_material(w, 0.6, 0);
        plumb_body crate = sim_crate(w, 0, 0, 0.5, 0.5, m);
        if (i == 0) { // out of the ground
            sim_floor(w, m);
        } else { // turned by a torque that is bounded
            const plumb_joint_desc d = {
                .kind = PLUMB_MOTOR, .body_b = crate, .rest = 1, .max_torque = 10
            };
            plumb_joint_create(w, &d);
        }
        sim_run(w, 600, HZ60);
        assert_true(i != 0 || fabs(sim_y(w, crate) - 0.5) < 1e-3);
        assert_true(i != 1 || fabs((double)plumb_body_angle(w, crate) - 1) < 1e-3);
        assert_false(plumb_body_is_awake(w, crate));
        plumb_world_destroy(w);
    }
}

//---- waking --------------------------------------------------------------------------------------

static void dominoes_wake_one_another(void **state)
{
    (void)state;
    plumb_world *w = sim_world(&(plumb_world_desc){ 0 });
    plumb_material m = sim_material(w, 0.6, 0);
    plumb_body tile[20];
    sim_floor(w, m);
    for (int i = 0; i < 20; ++i) {
        tile[i] = sim_crate(w, i, 1, 0.1, 1, m);
    }
    sim_run(w, 120, HZ60);
    assert_int_equal(plumb_world_stats(w).asleep_count, 20);
    assert_int_equal(plumb_world_stats(w).island_count, 20);
    plumb_body_apply_impulse(w, tile[0], sim_vec(0.6, 0), sim_vec(0, 2));
    uint32_t most = 0;
    int woken = 0;
    for (int i = 0; i < 60 * 20; ++i) {
        int count;
        sim_step(w, HZ60);
        plumb_world_wake_events(w, &count);
        woken += count;
        uint32_t awake = plumb_world_stats(w).dynamic_count;
        most = awake > most ? awake : most;
    }
    for (int i = 0; i < 20; ++i) {
        assert_true(sim_angle(w, tile[i]) < -1); // all fell
    }
    assert_true(woken >= 20);
    assert_int_equal(plumb_world_stats(w).dynamic_count, 0);
    plumb_world_destroy(w);
}

// The pile that sleeps is hit as the one that may not sleep is, in the step of the hit, bit for bit
// but for the impulses from which contacts start.
static void a_ball_meets_a_pile_asleep_as_one_awake(void **state)
{
    (void)state;
    double speed[2], push[2], deepest[2];
    for (int sleeps = 0; sleeps < 2; ++sleeps) {
        plumb_body b[MOST];
        plumb_world *w = sim_world(&(plumb_world_desc){ .no_sleep = !sleeps });
        plumb_material m = sim_material(w, 0.6, 0);
        sim_floor(w, m);
        build_pyramid(w, b, m);
        sim_run(w, 60 * 6, HZ60);
        assert_int_equal(plumb_world_stats(w).asleep_count, sleeps ? 210 : 0);
        plumb_body ball = sim_ball(w, -30, 4, 1, sim_material(w, 0.3, 0));
        sim_launch(w, ball, 40, 2, 0);
        double before = sim_vx(w, ball);
        deepest[sleeps] = 0;
        int steps = 0;
        while (fabs(sim_vx(w, ball) - before) < 1e-3 && ++steps < 120) {
            sim_step(w, HZ60);
        }
        speed[sleeps] = sim_vx(w, ball);
        push[sleeps] = 0;
        for (int i = 0; i < 210; ++i) {
            push[sleeps] += sim_vx(w, b[i]);
            assert_true(plumb_body_is_awake(w, b[i]));
        }
        for (int i = 0; i < 60; ++i) {
            double d = (double)plumb_world_stats(w).max_penetration;
            deepest[sleeps] = d > deepest[sleeps] ? d : deepest[sleeps];
            sim_step(w, HZ60);
        }
        plumb_world_destroy(w);
    }
    print_message("ball after the hit %.4f m/s, awake pile %.4f; pile %.3f and %.3f m/s; deepest "
                  "overlap %.3f and %.3f m\n",
                  speed[1], speed[0], push[1], push[0], deepest[1], deepest[0]);
    assert_near(speed[1], speed[0], 0.01);
    assert_near(push[1], push[0], 0.05);
    assert_true(deepest[1] < 1.5 * deepest[0] + 0.01);
}

// Equal elastic balls in contact: the momentum goes through the whole row in one step, asleep or
// not.
static void a_blow_goes_through_sleepers(void **state)
{
    (void)state;
    for (int made = 0; made < 2; ++made) {
        plumb_world *w = sim_space();
        plumb_material m = sim_material(w, 0, 1);
        plumb_body row[8];
        for (int i = 0; i < 8; ++i) {
            const plumb_body_desc desc = { .position = sim_vec(i, 0), .asleep = made == 1 };
            row[i] = plumb_body_create(w, &desc);
            sim_add_circle(w, row[i], 0.5, m);
        }
        sim_run(w, 60, HZ60);
        assert_int_equal(plumb_world_stats(w).asleep_count, 8);
        assert_int_equal(plumb_world_stats(w).island_count, made == 1 ? 8 : 1);
        plumb_body cue = sim_ball(w, -5, 0, 0.5, m);
        sim_launch(w, cue, 6, 0, 0);
        for (int i = 0; i < 60; ++i) {
            sim_step(w, HZ60);
            // There is no step in which the blow is under way.
            assert_near(sim_vx(w, cue) + sim_vx(w, row[7]), 6, ROUNDED(1e-3));
            for (int k = 0; k < 7; ++k) {
                assert_near(sim_vx(w, row[k]), 0, ROUNDED(1e-3));
            }
        }
        assert_near(sim_vx(w, row[7]), 6, ROUNDED(1e-3));
        assert_near(sim_vx(w, cue), 0, ROUNDED(1e-3));
        plumb_world_destroy(w);
    }
}

static void a_crate_falls_when_its_platform_goes(void **state)
{
    (void)state;
    for (int way = 0; way < 3; ++way) {
        plumb_world *w = sim_world(&(plumb_world_desc){ 0 });
        plumb_material m = sim_material(w, 0.6, 0);
        plumb_body platform = sim_body(w, PLUMB_STATIC, 0, 0, 0), shape_owner = platform;
        sim_add_box(w, platform, 2, 0.5, m);
        plumb_body low = sim_crate(w, 0, 1, 0.5, 0.5, m), high = sim_crate(w, 0, 2, 0.5, 0.5, m);
        sim_run(w, 120, HZ60);
        assert_false(plumb_body_is_awake(w, low) || plumb_body_is_awake(w, high));
        double y = sim_y(w, high);
        plumb_shape shape;
        plumb_body_shapes(w, shape_owner, &shape, 1);
        if (way == 0) {
            plumb_body_destroy(w, platform);
        } else if (way == 1) {
            plumb_shape_destroy(w, shape);
        } else {
            plumb_body_teleport(w, platform, sim_vec(0, -20), 0);
        }
        sim_run(w, 30, HZ60);
        assert_near(y - sim_y(w, high), 0.125 * SIM_G, 0.02);
        plumb_world_destroy(w);
    }
}

// Bodies that have rested long enough, and are kept awake by one that may not sleep, lose what they
// stand on in the step in which they would fall asleep.
static void who_is_about_to_sleep_falls_too(void **state)
{
    (void)state;
    for (int way = 0; way < 3; ++way) {
        for (int wait = 0; wait < 10; ++wait) {
            plumb_world *w = sim_world(&(plumb_world_desc){ 0 });
            plumb_material m = sim_material(w, 0.6, 0);
            plumb_body platform = sim_body(w, PLUMB_STATIC, 0, 0, 0);
            sim_add_box(w, platform, 2, 0.5, m);
            plumb_body low = sim_crate(w, 0, 1, 0.5, 0.5, m),
                       high = sim_crate(w, 0, 2, 0.5, 0.5, m);
            plumb_body_set_no_sleep(w, high, true);
            sim_run(w, 120 + wait, HZ60);
            plumb_body_set_no_sleep(w, high, false);
            double y = sim_y(w, low);
            if (way == 0) {
                plumb_body_destroy(w, platform);
            } else if (way == 1) {
                plumb_body_teleport(w, platform, sim_vec(0, -20), 0);
            } else { // lowered by less than contacts look ahead
                plumb_body_teleport(w, platform, sim_vec(0, -0.01), 0);
            }
            sim_run(w, 20, HZ60);
            assert_true(y - sim_y(w, low) > 0.009);
            plumb_world_destroy(w);
        }
    }
}

// Warm: a pile that wakes stands as it stood. Its impulses are those of before.
static void waking_does_not_shake(void **state)
{
    (void)state;
    plumb_body b[MOST];
    plumb_world *w = sim_world(&(plumb_world_desc){ 0 });
    plumb_material m = sim_material(w, 0.6, 0);
    sim_floor(w, m);
    build_pyramid(w, b, m);
    time_to_sleep(w, HZ60, 8);
    double force = sim_normal_force(w, b[0], b[20], HZ60);
    double fastest = 0;
    for (int round = 0; round < 5; ++round) {
        plumb_body_wake(w, b[7]);
        for (int i = 0; i < 20; ++i) {
            sim_step(w, HZ60);
            double v = sim_max_speed(w);
            fastest = v > fastest ? v : fastest;
        }
        assert_int_equal(plumb_world_stats(w).asleep_count, 0);
        time_to_sleep(w, HZ60, plumb_world_stats(w).time + 5);
        assert_int_equal(plumb_world_stats(w).asleep_count, 210);
    }
    double later = sim_normal_force(w, b[0], b[20], HZ60);
    print_message("woken pyramid: fastest %.2g m/s; force %.4f and %.4f N\n", fastest, force,
                  later);
    assert_true(fastest < 0.01);
    assert_true(force > 0 && fabs(later / force - 1) < 0.2);
    plumb_world_destroy(w);
}

//---- the same bits -------------------------------------------------------------------------------

static uint64_t digest(plumb_world *w)
{
    plumb_body_span s = plumb_world_bodies(w);
    const plumb_real *columns[] = { s.x, s.y, s.c, s.s, s.vx, s.vy, s.w };
    uint64_t hash = UINT64_C(14695981039346656037);
    for (size_t k = 0; k < sizeof columns / sizeof columns[0]; ++k) {
        for (size_t i = 0; i < (size_t)s.count * sizeof(plumb_real); ++i) {
            hash = (hash ^ ((const unsigned char *)columns[k])[i]) * UINT64_C(1099511628211);
        }
    }
    return hash;
}

static void widths_sleep_and_wake_alike(void **state)
{
    (void)state;
    const int widths[] = { 4, 8, 16 };
    uint64_t first = 0;
    int first_woken = 0;
    for (int k = 0; k < 3; ++k) {
        plumb_body b[MOST];
        plumb_world *w = sim_world(&(plumb_world_desc){ .simd_width = widths[k] });
        plumb_material m = sim_material(w, 0.6, 0);
        sim_floor(w, m);
        build_heap(w, b, m);
        int woken = 0;
        for (int i = 0; i < 60 * 20; ++i) {
            int count;
            if (i % 240 == 239) { // one after another is thrown in again
                plumb_body_teleport(w, b[i / 240], sim_vec(0, 8), 0);
            }
            sim_step(w, HZ60);
            plumb_world_wake_events(w, &count);
            woken += count;
        }
        assert_true(woken > 50);
        assert_true(k == 0 || (digest(w) == first && woken == first_woken));
        first = digest(w);
        first_woken = woken;
        plumb_world_destroy(w);
    }
}

// Crates rest on one end of a static body while at the other, 100 m away, its tiles are made, changed and taken away: they fall asleep as
// soon as if nothing was done. What lies on a tile that is changed does not rest.
static void far_tiles_let_sleep(void **state)
{
    (void)state;
    for (int kind = 0; kind < 6; ++kind) {
        plumb_world *w = sim_world(&(plumb_world_desc){ 0 });
        const plumb_material m = sim_material(w, 0.5, 0);
        const plumb_body ground = sim_floor(w, m);
        plumb_shape tiles[40];
        for (int i = 0; i < 40; ++i) {
            const plumb_shape_desc tile = { .kind = PLUMB_BOX,
                                            .half = sim_vec(0.5, 0.5),
                                            .center = sim_vec(100 + 2 * i, 5) };
            tiles[i] = plumb_shape_create(w, ground, &tile);
        }
        for (int i = 0; i < 3; ++i) {
            sim_crate(w, 3 * i, 0.5, 0.5, 0.5, m);
        }
        const plumb_body high = sim_crate(w, 100 + 2 * 39, 6, 0.5, 0.5, m); // on the last tile
        for (int step = 0; step < 90; ++step) {
            const plumb_shape tile = tiles[step / 3];
            const plumb_shape_desc round = { .kind = PLUMB_CIRCLE,
                                             .radius = (plumb_real)0.4,
                                             .center = sim_vec(100 + 2 * (step / 3), 5) };
            if (step % 3 == 0 && kind == 0) {
                plumb_shape_create(w, ground, &round);
            } else if (step % 3 == 0 && kind == 1) {
                plumb_shape_destroy(w, tile);
            } else if (step % 3 == 0 && kind == 2) {
                plumb_shape_set_filter(w, tile, (plumb_filter){ .category = 4 });
            } else if (step % 3 == 0 && kind == 3) {
                plumb_shape_set_sensor(w, tile, true);
            } else if (step % 3 == 0 && kind == 4) {
                plumb_shape_set_geometry(w, tile, &round);
            } else if (kind == 5) { // by turns, so that it is changed each time
                plumb_shape_set_filter(w, tiles[39],
                                       (plumb_filter){ .category = step % 2 == 0 ? 2 : 3 });
            }
            sim_step(w, 1 / 60.0);
        }
        assert_int_equal(plumb_world_stats(w).asleep_count, kind == 5 ? 3 : 4);
        assert_int_equal(plumb_body_is_awake(w, high), kind == 5);
        plumb_world_destroy(w);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(piles_fall_asleep),
        cmocka_unit_test(turning_points_are_no_rest),
        cmocka_unit_test(what_accelerates_slowly_is_no_rest),
        cmocka_unit_test(motion_above_the_threshold_goes_on),
        cmocka_unit_test(what_floats_drifts),
        cmocka_unit_test(moving_ground_keeps_awake),
        cmocka_unit_test(what_is_driven_slowly_goes_on),
        cmocka_unit_test(corrections_are_motion),
        cmocka_unit_test(dominoes_wake_one_another),
        cmocka_unit_test(a_ball_meets_a_pile_asleep_as_one_awake),
        cmocka_unit_test(a_blow_goes_through_sleepers),
        cmocka_unit_test(a_crate_falls_when_its_platform_goes),
        cmocka_unit_test(who_is_about_to_sleep_falls_too),
        cmocka_unit_test(waking_does_not_shake),
        cmocka_unit_test(widths_sleep_and_wake_alike),
        cmocka_unit_test(far_tiles_let_sleep),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
