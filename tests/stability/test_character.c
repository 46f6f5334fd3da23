// test_character.c - kinematic characters: the same way at any length of step, exact jumps, slopes,
// steps, seams, platforms that move and turn, one-way platforms, pushing and being pushed.
#include "walker.h"

static const double rates[] = { 30, 60, 144, 1000 };
#define RATES ((int)(sizeof rates / sizeof rates[0]))

//---- the length of a step does not matter -------------------------------------------------------

// Hills, stairs up and down, a wall of tiles: 37 m.
static void a_course(void **state)
{
    (void)state;
    double least = HUGE_VAL, most = -HUGE_VAL;
    const plumb_vec2 hills[] = { { -20, 0 }, { 5, 0 },  { 9, 2 },  { 13, 2 }, { 17, 0 },
                                 { 21, 0 },  { 25, 3 }, { 29, 3 }, { 60, 3 } };
    for (int k = 0; k < RATES; ++k) {
        plumb_world *world = make_world();
        add_chain(world, hills, 9);
        for (int i = 0; i < 4; ++i) { // 0.2 m each, down on the other side in one flight of stairs
            add_box(world, PLUMB_STATIC, V(31, 3.1 + 0.2 * i), V(1.6 - 0.35 * i, 0.1));
        }
        plumb_body hero = add_hero(world, 0, 0, NULL);
        plumb_character_walk(world, hero, 3);
        run(world, rates[k], 13);
        plumb_character_state s = state_of(world, hero);
        assert_true(s.on_ground && !s.at_wall);
        NEAR(feet_of(world, hero), 3, 1e-5);
        least = fmin(least, x_of(world, hero));
        most = fmax(most, x_of(world, hero));
        plumb_world_destroy(world);
    }
    print_message("end of the course: %.4f to %.4f m\n", least, most);
    assert_true(least > 36 && most - least < 0.015);
}

// y = v t - g t^2 / 2 and x = u t at every step, up to the landing, and on from there.
static void jumps_are_exact(void **state)
{
    (void)state;
    for (int k = 0; k < RATES; ++k) {
        plumb_world *world = make_world();
        add_floor(world);
        plumb_body hero = add_hero(world, -5, 0, NULL);
        plumb_character_walk(world, hero, 3);
        run(world, rates[k], 0.5);
        NEAR(x_of(world, hero), -3.5, 1e-5);
        assert_true(plumb_character_jump(world, hero, 6));
        double landing = 2 * 6 / 9.81, highest = 0;
        int steps = (int)(landing * rates[k]);
        for (int i = 1; i <= steps; ++i) {
            double t = i / rates[k];
            run(world, rates[k], 1 / rates[k]);
            NEAR(feet_of(world, hero), 6 * t - 9.81 / 2 * t * t, 5e-5);
            NEAR(x_of(world, hero), -3.5 + 3 * t, 5e-5);
            highest = fmax(highest, feet_of(world, hero));
            assert_false(state_of(world, hero).on_ground);
            assert_false(plumb_character_jump(world, hero, 6)); // not in the air
        }
        NEAR(highest, 6 * 6 / (2 * 9.81), 9.81 / (8 * rates[k] * rates[k]) + 1e-4);
        run(world, rates[k], 1.5 - steps / rates[k]);
        assert_true(state_of(world, hero).on_ground);
        NEAR(x_of(world, hero), -3.5 + 4.5, 1e-4);
        NEAR(feet_of(world, hero), 0, 1e-5);
        plumb_world_destroy(world);
    }
}

// From platform to platform: over gaps, through one-way planks, down again. Orders at half seconds.
static void a_tour_of_jumps(void **state)
{
    (void)state;
    double least = HUGE_VAL, most = -HUGE_VAL;
    for (int k = 0; k < RATES; ++k) {
        plumb_world *world = make_world();
        add_box(world, PLUMB_STATIC, V(0, -0.5), V(3, 0.5));
        add_box(world, PLUMB_STATIC, V(8, 0), V(2, 0.5));
        plumb_body plank = add_body(world, PLUMB_STATIC, V(14, 1.5));
        plumb_shape_create(world, plank,
                           &(plumb_shape_desc){ .kind = PLUMB_BOX,
                                                .half = { 2, R(0.1) },
                                                .one_way = { { 0, 1 }, 0 } });
        add_box(world, PLUMB_STATIC, V(14, -0.5), V(6, 0.5));
        plumb_body hero = add_hero(world, 0, 0, NULL);
        plumb_character_walk(world, hero, 4);
        run(world, rates[k], 0.5); // x = 2
        assert_true(plumb_character_jump(world, hero, 7));
        run(world, rates[k], 1.5); // over the gap, x = 8
        assert_true(plumb_character_jump(world, hero, 7));
        run(world, rates[k], 1.5); // x = 14, up on the plank
        NEAR(feet_of(world, hero), 1.6, 1e-4);
        plumb_character_walk(world, hero, 1);
        assert_true(plumb_character_drop(world, hero));
        run(world, rates[k], 1.5);
        NEAR(feet_of(world, hero), 0, 1e-4);
        least = fmin(least, x_of(world, hero));
        most = fmax(most, x_of(world, hero));
        plumb_world_destroy(world);
    }
    print_message("end of the tour: %.5f to %.5f m\n", least, most);
    assert_true(least > 15 && most - least < 0.002);
}

//---- slopes -------------------------------------------------------------------------------------

static void slopes(void **state)
{
    (void)state;
    for (int degrees = 10; degrees <= 45; degrees += 5) {
        double a = degrees * 0.017453292519943295;
        const plumb_vec2 hill[] = { V(-30, 0), V(0, 0), V(20 * cos(a), 20 * sin(a)),
                                    V(40 * cos(a), 0), V(70, 0) };
        plumb_world *world = make_world();
        add_chain(world, hill, 5);
        plumb_body hero = add_hero(world, 3 * cos(a), 3 * sin(a) + 0.3, NULL);
        run(world, 60, 0.5);
        plumb_vec2 p = plumb_body_position(world, hero);
        run(world, 60, 5); // it stands: not a micrometre downhill
        NEAR(plumb_vec2_distance(p, plumb_body_position(world, hero)), 0, 1e-6);
        plumb_character_walk(world, hero, 3); // 3 m/s along the slope, up and down
        run(world, 60, 2);
        NEAR(plumb_vec2_distance(p, plumb_body_position(world, hero)), 6, 1e-3);
        plumb_character_walk(world, hero, -3);
        run(world, 60, 2);
        NEAR(plumb_vec2_distance(p, plumb_body_position(world, hero)), 0, 2e-3);
        assert_true(state_of(world, hero).on_ground);
        plumb_world_destroy(world);
    }
}

// Too steep: it slides down with g sin a, and running into it does not carry it up.
static void too_steep(void **state)
{
    (void)state;
    double a = 1.1;
    const plumb_vec2 hill[] = { V(-30, 0), V(0, 0), V(30 * cos(a), 30 * sin(a)) };
    plumb_world *world = make_world();
    add_chain(world, hill, 3);
    plumb_body hero = add_hero(world, 9 * cos(a), 9 * sin(a) + 2,
                               &(plumb_character_desc){ .no_air_control = true });
    while (!state_of(world, hero).on_slope) {
        run(world, 240, 1.0 / 240);
    }
    run(world, 240, 0.1);
    plumb_character_state s = state_of(world, hero);
    double v0 = (double)plumb_vec2_magnitude(s.velocity);
    assert_true(!s.on_ground && s.on_slope);
    run(world, 240, 0.25);
    NEAR(plumb_vec2_magnitude(state_of(world, hero).velocity) - R(v0), 9.81 * sin(a) * 0.25, 1e-2);
    plumb_world_destroy(world);
    for (int k = 0; k < RATES; ++k) {
        world = make_world();
        add_chain(world, hill, 3);
        hero = add_hero(world, -3, 0, NULL);
        plumb_character_walk(world, hero, 5);
        double highest = 0;
        for (int i = 0; i < (int)(3 * rates[k]); ++i) {
            run(world, rates[k], 1 / rates[k]);
            highest = fmax(highest, feet_of(world, hero));
            plumb_character_jump(world, hero, 3);
        }
        assert_true(highest < 3 * 3 / (2 * 9.81) + 0.05); // no higher than it jumps
        plumb_world_destroy(world);
    }
}

static void between_two_slopes_it_stands(void **state)
{
    (void)state;
    const plumb_vec2 gorge[] = { { -2, 6 }, { 0, 0 }, { 2, 6 } };
    plumb_world *world = make_world();
    add_chain(world, gorge, 3);
    plumb_body hero = add_hero(world, 0, 3, NULL);
    run(world, 60, 3);
    assert_true(state_of(world, hero).on_ground);
    assert_true(plumb_character_jump(world, hero, 4));
    double y = y_of(world, hero);
    run(world, 60, 0.3);
    assert_true(y_of(world, hero) > y + 0.5);
    plumb_world_destroy(world);
}

//---- ground of many pieces ------------------------------------------------------------------------

// Tiles in a row, some a few micrometres high or low: every step is as long as the one before.
static void seams(void **state)
{
    (void)state;
    for (int is_box = 0; is_box < 2; ++is_box) {
        for (int uneven = 0; uneven < 2; ++uneven) {
            plumb_world *world = make_world();
            for (int i = -4; i < 60; ++i) {
                double off = uneven ? ((i * 7) % 5 - 2) * 2e-6 : 0;
                add_box(world, PLUMB_STATIC, V(i * 0.5, -0.25 + off), V(0.25, 0.25));
            }
            plumb_body hero = add_hero(world, 0, 0.1, NULL);
            if (is_box) {
                plumb_shape old;
                plumb_body_shapes(world, hero, &old, 1);
                plumb_shape_destroy(world, old);
                plumb_shape_create(
                    world, hero,
                    &(plumb_shape_desc){ .kind = PLUMB_BOX, .half = { R(RADIUS), R(STANDS) } });
            }
            run(world, 60, 0.5);
            for (int side = 1; side >= -1; side -= 2) {
                plumb_character_walk(world, hero, R(side * 3));
                for (int i = 0; i < 400; ++i) {
                    double x = x_of(world, hero);
                    run(world, 60, 1.0 / 60);
                    NEAR(x_of(world, hero) - x, side * 0.05, 1e-5);
                    assert_true(state_of(world, hero).on_ground);
                    assert_false(state_of(world, hero).at_wall);
                }
            }
            plumb_world_destroy(world);
        }
    }
}

// Uphill over the corners of a many-cornered hill (a corner every 4 cm), and down again.
static void uphill_over_corners(void **state)
{
    (void)state;
    plumb_vec2 hill[301];
    for (int i = 0; i <= 300; ++i) {
        double x = i * 0.04;
        hill[i] = V(x, 0.6 * sin(x) + 0.01 * (i % 3));
    }
    plumb_world *world = make_world();
    add_chain(world, hill, 301);
    plumb_body hero = add_hero(world, 1, 0.7, NULL);
    run(world, 60, 0.5);
    plumb_character_walk(world, hero, 2);
    for (int i = 0; i < 300; ++i) {
        plumb_vec2 p = plumb_body_position(world, hero);
        run(world, 60, 1.0 / 60);
        double way = (double)plumb_vec2_distance(p, plumb_body_position(world, hero));
        assert_true(way > 0.8 * 2 / 60 && way < 1.005 * 2 / 60);
        assert_true(state_of(world, hero).on_ground);
    }
    plumb_world_destroy(world);
}

// Off an edge at a run it flies straight on; at a stroll it rolls over it.
static void edges(void **state)
{
    (void)state;
    plumb_world *world = make_world();
    add_box(world, PLUMB_STATIC, V(-5, -1), V(5, 1));
    plumb_body hero = add_hero(world, -1, 0, NULL);
    plumb_character_walk(world, hero, 4);
    run(world, 60, 0.5); // a quarter of a second past the edge
    double t = 0.25;
    NEAR(x_of(world, hero), 1, 1e-4);
    NEAR(feet_of(world, hero), -9.81 / 2 * t * t, 2e-3);
    plumb_world_destroy(world);
}

//---- what carries it ------------------------------------------------------------------------------

// Sideways, up and down, fast: it keeps its place on the platform to a tenth of a millimetre.
static void moving_platforms(void **state)
{
    (void)state;
    for (int k = 0; k < RATES; ++k) {
        plumb_world *world = make_world();
        plumb_body lift = add_box(world, PLUMB_KINEMATIC, V(0, -0.2), V(2, 0.2));
        plumb_body hero = add_hero(world, 0.5, 0, NULL);
        run(world, rates[k], 0.1);
        for (int i = 0; i < (int)(6 * rates[k]); ++i) {
            double t = i / rates[k];
            plumb_body_set_velocity(world, lift, V(5 * cos(3 * t), 3 * sin(2 * t)));
            run(world, rates[k], 1 / rates[k]);
            plumb_vec2 at = plumb_body_local_point(world, lift, plumb_body_position(world, hero));
            NEAR(at.x, 0.5, 1e-4);
            NEAR(at.y, 0.2 + STANDS + SKIN, 1e-4);
        }
        plumb_character_state s = state_of(world, hero);
        assert_true(plumb_same(s.ground_body, lift));
        NEAR(s.ground_velocity.x, plumb_body_velocity(world, lift).x, 1e-4);
        plumb_world_destroy(world);
    }
}

// A seesaw and a wheel: the foot keeps its place on what turns under it.
static void turning_platforms(void **state)
{
    (void)state;
    for (int k = 0; k < RATES; ++k) {
        plumb_world *world = make_world();
        plumb_body plate = add_box(world, PLUMB_KINEMATIC, V(0, -0.2), V(3, 0.2));
        plumb_body hero = add_hero(world, 2, 0, NULL);
        run(world, rates[k], 0.1);
        for (int i = 0; i < (int)(5 * rates[k]); ++i) {
            plumb_body_set_angular_velocity(world, plate, R(0.6 * cos(2 * i / rates[k])));
            run(world, rates[k], 1 / rates[k]);
            assert_true(state_of(world, hero).on_ground);
        }
        plumb_character_state s = state_of(world, hero);
        plumb_vec2 foot = plumb_body_local_point(world, plate, s.ground_point);
        // As the plate tilts, the place where a round foot touches it rolls to and fro by R sin a.
        NEAR(foot.x, 2, (RADIUS + SKIN) * sin(0.31));
        NEAR(foot.y, 0.2, 1e-4);
        NEAR(s.ground_spin, 0.6 * cos(2 * (5 - 1 / rates[k])), 1e-3);
        plumb_world_destroy(world);
        // A gondola at the end of an arm that turns at 1 rad/s: round and round with it.
        world = make_world();
        plumb_body wheel = add_body(world, PLUMB_KINEMATIC, V(0, 0));
        plumb_shape_create(world, wheel, &(plumb_shape_desc){ .kind = PLUMB_CIRCLE, .radius = 4 });
        hero = add_hero(world, 0, 4, NULL);
        run(world, rates[k], 0.1);
        plumb_body_set_angular_velocity(world, wheel, R(-0.2));
        run(world, rates[k], 2);
        s = state_of(world, hero);
        foot = plumb_body_local_point(world, wheel, s.ground_point);
        assert_true(s.on_ground);
        // The foot itself does not turn: carried without slip, it goes round by w R / (R + r).
        NEAR(atan2((double)s.ground_point.x, (double)s.ground_point.y),
             0.4 * 4 / (4 + RADIUS + SKIN), 1e-3);
        plumb_world_destroy(world);
    }
}

// It takes the platform's velocity along when it jumps off, and walks relative to it.
static void off_a_platform(void **state)
{
    (void)state;
    for (int k = 0; k < RATES; ++k) {
        plumb_world *world = make_world();
        plumb_body lift = add_box(world, PLUMB_KINEMATIC, V(0, -0.2), V(4, 0.2));
        plumb_body hero = add_hero(world, 0, 0, &(plumb_character_desc){ .no_air_control = true });
        run(world, rates[k], 0.1);
        plumb_body_set_velocity(world, lift, V(2, 1));
        run(world, rates[k], 0.5);
        plumb_character_walk(world, hero, 1);
        run(world, rates[k], 0.5);
        NEAR(x_of(world, hero), 2 + 0.5, 1e-4);
        assert_true(plumb_character_jump(world, hero, 5));
        double x = x_of(world, hero), y = y_of(world, hero);
        run(world, rates[k], 0.5);
        NEAR(x_of(world, hero) - x, 1.5, 1e-4);
        NEAR(y_of(world, hero) - y, 6 * 0.5 - 9.81 / 8, 1e-4);
        plumb_world_destroy(world);
    }
}

//---- one-way platforms ----------------------------------------------------------------------------

static plumb_body add_plank(plumb_world *world, plumb_body_type type, plumb_vec2 at)
{
    plumb_body plank = add_body(world, type, at);
    plumb_shape_create(world, plank,
                       &(plumb_shape_desc){ .kind = PLUMB_BOX,
                                            .half = { 2, R(0.1) },
                                            .center = { 0, R(-0.1) },
                                            .one_way = { { 0, 1 }, 0 } });
    return plank;
}

// Jumps that end below, inside and above the plank: free flight till the feet are out on top.
static void one_way_from_below(void **state)
{
    (void)state;
    for (int k = 0; k < RATES; ++k) {
        for (int tenth = -5; tenth <= 5; ++tenth) {
            plumb_world *world = make_world();
            add_floor(world);
            add_plank(world, PLUMB_STATIC, V(0, 1.5));
            plumb_body hero = add_hero(world, 0, 0, NULL);
            run(world, rates[k], 0.1);
            double top = 1.5 + 0.1 * tenth + 0.03, v = sqrt(2 * 9.81 * top);
            plumb_character_jump(world, hero, R(v));
            double landing = top > 1.5 ? (v + sqrt(v * v - 2 * 9.81 * 1.5)) / 9.81 : 2 * v / 9.81;
            int steps = (int)(landing * rates[k]);
            for (int i = 1; i <= steps; ++i) {
                double t = i / rates[k];
                run(world, rates[k], 1 / rates[k]);
                NEAR(feet_of(world, hero), v * t - 9.81 / 2 * t * t, 1e-4);
            }
            run(world, rates[k], 0.5);
            NEAR(feet_of(world, hero), top > 1.5 ? 1.5 : 0, 1e-4);
            assert_true(state_of(world, hero).on_ground);
            plumb_world_destroy(world);
        }
    }
}

static void one_way_carries_and_drops(void **state)
{
    (void)state;
    for (int k = 0; k < RATES; ++k) {
        plumb_world *world = make_world();
        add_floor(world);
        plumb_body plank = add_plank(world, PLUMB_KINEMATIC, V(0, 2));
        plumb_body other = add_plank(world, PLUMB_STATIC, V(0, 1));
        plumb_body hero = add_hero(world, 0, 2, NULL);
        plumb_body_set_velocity(world, plank, V(0.5, 0.5));
        run(world, rates[k], 1);
        plumb_vec2 at = plumb_body_local_point(world, plank, plumb_body_position(world, hero));
        NEAR(at.y, STANDS + SKIN, 1e-4);
        assert_true(plumb_same(state_of(world, hero).ground_body, plank));
        assert_true(plumb_character_drop(world, hero));
        assert_false(plumb_character_drop(world, hero)); // in the air by now
        run(world, rates[k], 1.5);
        assert_true(plumb_same(state_of(world, hero).ground_body, other));
        NEAR(feet_of(world, hero), 1, 1e-4);
        assert_true(plumb_character_drop(world, hero));
        run(world, rates[k], 1.5);
        NEAR(feet_of(world, hero), 0, 1e-4);
        assert_false(plumb_character_drop(world, hero)); // the floor is solid
        plumb_world_destroy(world);
    }
}

// Walking into the end of a plank at its own height is walking through it.
static void one_way_from_the_side(void **state)
{
    (void)state;
    plumb_world *world = make_world();
    add_floor(world);
    add_plank(world, PLUMB_STATIC, V(0, 0.8));
    plumb_body hero = add_hero(world, -4, 0, NULL);
    plumb_character_walk(world, hero, 3);
    run(world, 60, 3);
    NEAR(x_of(world, hero), 5, 1e-3);
    NEAR(feet_of(world, hero), 0, 1e-5);
    plumb_world_destroy(world);
}

//---- pushing ----------------------------------------------------------------------------------------

static plumb_body add_crate(plumb_world *world, double x, double mass)
{
    plumb_body crate = add_box(world, PLUMB_DYNAMIC, V(x, 0.5), V(0.5, 0.5));
    plumb_body_set_mass(world, crate, R(mass));
    return crate;
}

// A crate that it is strong enough for goes at its speed, however long the steps.
static void pushes_crates(void **state)
{
    (void)state;
    for (int k = 0; k < RATES; ++k) {
        plumb_world *world = make_world();
        add_floor(world);
        plumb_body crate = add_crate(world, 2, 40); // friction 0.6: 235 N of 700 N
        plumb_body hero = add_hero(world, 0, 0, NULL);
        plumb_character_walk(world, hero, 2);
        run(world, rates[k], 2);
        double x = x_of(world, crate);
        run(world, rates[k], 2);
        NEAR(x_of(world, crate) - x, 4, 1e-3);
        NEAR(x_of(world, crate) - x_of(world, hero), 0.5 + RADIUS, 0.08);
        assert_true(state_of(world, hero).at_wall);
        plumb_world_destroy(world);
    }
}

// Against a kinematic body there is nothing to be done: it is pushed, or squeezed.
static void is_pushed(void **state)
{
    (void)state;
    for (int k = 0; k < RATES; ++k) {
        plumb_world *world = make_world();
        add_floor(world);
        plumb_body wall = add_box(world, PLUMB_KINEMATIC, V(-2, 1.1), V(0.5, 1));
        plumb_body hero = add_hero(world, 0, 0, NULL);
        plumb_body_set_velocity(world, wall, V(3, 0));
        run(world, rates[k], 2);
        NEAR(x_of(world, hero) - x_of(world, wall), 0.5 + RADIUS + SKIN, 1e-3);
        assert_true(state_of(world, hero).on_ground);
        assert_false(state_of(world, hero).crushed);
        add_box(world, PLUMB_STATIC, V(x_of(world, hero) + 2, 1.1), V(0.5, 1));
        bool crushed = false;
        for (int i = 0; i < (int)(rates[k]); ++i) {
            run(world, rates[k], 1 / rates[k]);
            crushed |= state_of(world, hero).crushed;
        }
        assert_true(crushed);
        plumb_world_destroy(world);
    }
}

static void characters_meet(void **state)
{
    (void)state;
    plumb_world *world = make_world();
    add_floor(world);
    plumb_body a = add_hero(world, -2, 0, NULL), b = add_hero(world, 2, 0, NULL);
    plumb_character_walk(world, a, 3);
    plumb_character_walk(world, b, -3);
    run(world, 60, 2);
    NEAR(x_of(world, b) - x_of(world, a), 2 * RADIUS + SKIN, 0.02);
    NEAR(x_of(world, a) + x_of(world, b), 0, 0.1);
    // One on the head of the other is carried along, whichever was made first.
    for (int first = 0; first < 2; ++first) {
        plumb_body low = first ? a : b, high = first ? b : a;
        plumb_body_teleport(world, low, V(5, STANDS + SKIN), 0);
        plumb_body_teleport(world, high, V(5, 3 * STANDS + 2 * SKIN), 0);
        plumb_character_walk(world, low, 0);
        plumb_character_walk(world, high, 0);
        run(world, 60, 0.5);
        assert_true(plumb_same(state_of(world, high).ground_body, low));
        plumb_character_walk(world, low, 2);
        run(world, 60, 1);
        NEAR(x_of(world, low), 7, 1e-3);
        NEAR(x_of(world, high), 7, 1e-3);
    }
    plumb_world_destroy(world);
}

//---- the rest of the world --------------------------------------------------------------------------

static void ceilings(void **state)
{
    (void)state;
    plumb_world *world = make_world();
    add_floor(world);
    add_box(world, PLUMB_STATIC, V(0, 3), V(5, 0.5)); // room for 0.7 m
    plumb_body hero = add_hero(world, 0, 0, NULL);
    run(world, 60, 0.1);
    plumb_character_jump(world, hero, 6);
    double highest = 0;
    bool at_ceiling = false;
    for (int i = 0; i < 60; ++i) {
        run(world, 60, 1.0 / 60);
        highest = fmax(highest, feet_of(world, hero));
        at_ceiling |= state_of(world, hero).at_ceiling;
    }
    assert_true(at_ceiling);
    NEAR(highest, 2.5 - 2 * STANDS - 2 * SKIN, 1e-3);
    NEAR(feet_of(world, hero), 0, 1e-4);
    plumb_world_destroy(world);
}

// The same walk and jump in a world whose y points down, and in one that falls to the left.
static void which_way_is_up(void **state)
{
    (void)state;
    for (int k = 0; k < 3; ++k) {
        // Right and up of each world.
        const plumb_vec2 right[] = { { 1, 0 }, { -1, 0 }, { 0, -1 } };
        const plumb_vec2 up[] = { { 0, 1 }, { 0, -1 }, { 1, 0 } };
        plumb_world_desc desc = { .y_axis = k == 1 ? PLUMB_Y_DOWN : PLUMB_Y_UP };
        desc.gravity = k == 2 ? V(-9.81, 0) : V(0, 0);
        plumb_world *world = NULL;
        plumb_world_create(&desc, &world);
        plumb_rot q = plumb_rot_from_direction(right[k]);
        plumb_body floor = add_box(world, PLUMB_STATIC, plumb_vec2_neg(up[k]), V(100, 1));
        plumb_body_teleport(world, floor, plumb_vec2_neg(up[k]), plumb_rot_angle(q));
        plumb_body hero = add_hero(world, 0, 0, NULL);
        plumb_body_teleport(world, hero, plumb_vec2_scale(R(STANDS + SKIN), up[k]),
                            plumb_rot_angle(q));
        plumb_character_walk(world, hero, 3);
        run(world, 60, 1);
        plumb_vec2 p = plumb_body_position(world, hero);
        NEAR(plumb_vec2_dot(p, right[k]), 3, 1e-4);
        NEAR(plumb_vec2_dot(p, up[k]), STANDS + SKIN, 1e-4);
        assert_true(plumb_character_jump(world, hero, 5));
        run(world, 60, 0.5);
        p = plumb_body_position(world, hero);
        NEAR(plumb_vec2_dot(p, right[k]), 4.5, 1e-4);
        NEAR(plumb_vec2_dot(p, up[k]) - R(STANDS + SKIN), 2.5 - 9.81 / 8, 1e-4);
        plumb_world_destroy(world);
    }
}

static void comes_out_of_what_it_was_put_in(void **state)
{
    (void)state;
    plumb_world *world = make_world();
    add_floor(world);
    add_box(world, PLUMB_STATIC, V(3, 1), V(0.5, 1));
    plumb_body hero = add_hero(world, 0, -0.7, NULL);
    plumb_body other = add_hero(world, 2.4, 0, NULL);
    run(world, 60, 0.05);
    assert_true(feet_of(world, hero) < -0.2); // not at once: no faster than contacts push
    run(world, 60, 0.5);
    NEAR(feet_of(world, hero), 0, 1e-4);
    NEAR(x_of(world, other), 2.5 - RADIUS - SKIN, 1e-4);
    plumb_world_destroy(world);
}

// Other bodies see it as a kinematic body: crates rest on its head, sensors notice it.
static void is_a_body_to_others(void **state)
{
    (void)state;
    plumb_world *world = make_world();
    add_floor(world);
    plumb_body coin = add_body(world, PLUMB_STATIC, V(3, 1));
    plumb_shape_create(
        world, coin, &(plumb_shape_desc){ .kind = PLUMB_CIRCLE, .radius = R(0.2), .sensor = true });
    plumb_body hero = add_hero(world, 0, 0, NULL);
    plumb_body crate = add_box(world, PLUMB_DYNAMIC, V(0, 3), V(0.3, 0.3));
    run(world, 60, 2);
    NEAR(y_of(world, crate), 2 * STANDS + SKIN + 0.3, 0.01);
    NEAR(feet_of(world, hero), 0, 1e-5);
    plumb_character_walk(world, hero, 3);
    int seen = 0;
    for (int i = 0; i < 90; ++i) {
        int count;
        run(world, 60, 1.0 / 60);
        plumb_world_sensor_begin_events(world, &count);
        seen += count;
    }
    assert_int_equal(seen, 1);
    plumb_world_destroy(world);
}

static void ground_may_go(void **state)
{
    (void)state;
    plumb_world *world = make_world();
    add_floor(world);
    plumb_body plate = add_box(world, PLUMB_STATIC, V(0, 1), V(2, 0.5));
    plumb_body hero = add_hero(world, 0, 1.5, NULL);
    run(world, 60, 0.2);
    assert_true(state_of(world, hero).on_ground);
    plumb_body_destroy(world, plate);
    run(world, 60, 0.1);
    assert_false(state_of(world, hero).on_ground);
    run(world, 60, 1);
    NEAR(feet_of(world, hero), 0, 1e-4);
    plumb_shape shape;
    plumb_body_shapes(world, hero, &shape, 1);
    plumb_shape_destroy(world, shape); // nothing to stand with: it stays where it is
    run(world, 60, 1);
    NEAR(feet_of(world, hero), 0, 1e-4);
    assert_false(state_of(world, hero).on_ground);
    plumb_world_destroy(world);
}

// A plank on a pivot that sleeps: who lands on it wakes it, and it does not sleep under him.
static void sleeping_ground(void **state)
{
    (void)state;
    plumb_world *world = make_world();
    plumb_body plank = add_box(world, PLUMB_DYNAMIC, V(0, 1), V(3, 0.1));
    plumb_body_set_mass(world, plank, 10);
    plumb_joint_create(world, &(plumb_joint_desc){ .kind = PLUMB_REVOLUTE,
                                                   .body_b = plank,
                                                   .anchor = { R(-0.5), 1 },
                                                   .enable_limit = true,
                                                   .lower = R(-0.2),
                                                   .upper = R(0.2) });
    run(world, 60, 4); // its long end is down
    assert_true(plumb_body_angle(world, plank) < R(-0.19));
    assert_false(plumb_body_is_awake(world, plank));
    plumb_body hero = add_hero(world, -2, 2.5, NULL);
    run(world, 60, 3); // he is heavier
    assert_true(plumb_body_angle(world, plank) > R(0.18));
    assert_true(plumb_body_is_awake(world, plank));
    assert_true(state_of(world, hero).on_ground);
    assert_int_equal(plumb_body_sleep(world, plank), PLUMB_OK); // put to sleep under him
    run(world, 60, 1);
    assert_false(plumb_body_is_awake(world, plank));
    assert_true(plumb_character_jump(world, hero, 6));
    run(world, 60, 0.6);
    assert_true(plumb_body_is_awake(world, plank));
    assert_true(plumb_body_angle(world, plank) < R(0.1)); // free, it falls to the other side
    plumb_world_destroy(world);
}

// Slow motion: the same jump at half pace takes twice as long; a platform at half pace carries half as far.
static void own_time(void **state)
{
    (void)state;
    plumb_world *world = make_world();
    add_floor(world);
    plumb_body lift = add_box(world, PLUMB_KINEMATIC, V(20, -0.2 + 1), V(2, 0.2));
    plumb_body slow = add_hero(world, 0, 0, NULL), rider = add_hero(world, 20, 1, NULL);
    plumb_character_walk(world, slow, 2);
    run(world, 60, 0.2);
    plumb_body_set_time_scale(world, slow, R(0.5));
    plumb_body_set_time_scale(world, lift, R(0.5));
    plumb_body_set_velocity(world, lift, V(1, 1));
    double x = x_of(world, slow);
    assert_true(plumb_character_jump(world, slow, 6));
    run(world, 60, 1);
    NEAR(feet_of(world, slow), 6 * 0.5 - 9.81 / 8, 1e-4);
    NEAR(x_of(world, slow) - x, 1, 1e-4);
    NEAR(x_of(world, rider), 20.5, 1e-3);
    NEAR(feet_of(world, rider), 1.5, 1e-3);
    plumb_world_destroy(world);
}

static void other_types(void **state)
{
    (void)state;
    plumb_world *world = make_world();
    add_floor(world);
    plumb_body hero = add_hero(world, 0, 0, NULL);
    plumb_character_walk(world, hero, 2);
    run(world, 60, 0.5);
    assert_int_equal(plumb_body_set_type(world, hero, PLUMB_DYNAMIC), PLUMB_OK);
    plumb_body_set_fixed_rotation(world, hero, true);
    run(world, 60, 1);
    NEAR(x_of(world, hero), 3, 0.1);
    plumb_body_set_type(world, hero, PLUMB_STATIC);
    run(world, 60, 0.5);
    NEAR(x_of(world, hero), 3, 0.1);
    plumb_body_set_type(world, hero, PLUMB_KINEMATIC);
    plumb_body_set_enabled(world, hero, false);
    run(world, 60, 0.5);
    NEAR(x_of(world, hero), 3, 0.1);
    plumb_body_set_enabled(world, hero, true);
    run(world, 60, 1);
    NEAR(x_of(world, hero), 5, 0.1);
    assert_true(state_of(world, hero).on_ground);
    plumb_world_destroy(world);
}

static void far_from_the_origin(void **state)
{
    (void)state;
    double end[2];
    for (int k = 0; k < 2; ++k) {
        plumb_world *world = make_world();
        const double x0 = 2000 * k;
        add_box(world, PLUMB_STATIC, V(x0, -1), V(100, 1));
        for (int i = 0; i < 3; ++i) {
            add_box(world, PLUMB_STATIC, V(x0 + 6, 0.1 + 0.2 * i), V(2 - 0.4 * i, 0.1));
        }
        plumb_body hero = add_hero(world, x0, 0, NULL);
        plumb_character_walk(world, hero, 3);
        run(world, 60, 4);
        end[k] = x_of(world, hero) - x0;
        NEAR(feet_of(world, hero), 0, 1e-3);
        plumb_world_destroy(world);
    }
    NEAR(end[0], end[1], 0.02);
    assert_true(end[0] > 11);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_course),
        cmocka_unit_test(jumps_are_exact),
        cmocka_unit_test(a_tour_of_jumps),
        cmocka_unit_test(slopes),
        cmocka_unit_test(too_steep),
        cmocka_unit_test(between_two_slopes_it_stands),
        cmocka_unit_test(seams),
        cmocka_unit_test(uphill_over_corners),
        cmocka_unit_test(edges),
        cmocka_unit_test(moving_platforms),
        cmocka_unit_test(turning_platforms),
        cmocka_unit_test(off_a_platform),
        cmocka_unit_test(one_way_from_below),
        cmocka_unit_test(one_way_carries_and_drops),
        cmocka_unit_test(one_way_from_the_side),
        cmocka_unit_test(pushes_crates),
        cmocka_unit_test(is_pushed),
        cmocka_unit_test(characters_meet),
        cmocka_unit_test(ceilings),
        cmocka_unit_test(which_way_is_up),
        cmocka_unit_test(comes_out_of_what_it_was_put_in),
        cmocka_unit_test(is_a_body_to_others),
        cmocka_unit_test(ground_may_go),
        cmocka_unit_test(sleeping_ground),
        cmocka_unit_test(own_time),
        cmocka_unit_test(other_types),
        cmocka_unit_test(far_from_the_origin),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
