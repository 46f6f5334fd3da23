// test_character_carried.c - characters on what moves, on one-way platforms, and pushing.
#include "walker.h"

//---- what carries it ------------------------------------------------------------------------------

// Sideways, up and down, fast: it keeps its place on the platform to a tenth of a millimetre.
static void moving_platforms(void **state)
{
    (void)state;
    for (int k = 0; k < STEP_RATES; ++k) {
        plumb_world *world = make_world();
        plumb_body lift = add_box(world, PLUMB_KINEMATIC, V(0, -0.2), V(2, 0.2));
        plumb_body hero = add_hero(world, 0.5, 0, NULL);
        run(world, step_rates[k], 0.1);
        for (int i = 0; i < (int)(6 * step_rates[k]); ++i) {
            double t = i / step_rates[k];
            plumb_body_set_velocity(world, lift, V(5 * cos(3 * t), 3 * sin(2 * t)));
            run(world, step_rates[k], 1 / step_rates[k]);
            plumb_vec2 at = plumb_body_local_point(world, lift, plumb_body_position(world, hero));
            assert_near(at.x, 0.5, ROUNDED(1e-4));
            assert_near(at.y, 0.2 + STANDS + SKIN, ROUNDED(1e-4));
        }
        plumb_character_state s = state_of(world, hero);
        assert_true(plumb_same(s.ground_body, lift));
        assert_near(s.ground_velocity.x, plumb_body_velocity(world, lift).x, ROUNDED(1e-4));
        plumb_world_destroy(world);
    }
}

// A seesaw and a wheel: the foot keeps its place on what turns under it.
// Of either kind, and by a belt that itself is carried: up to 0.1 m less for those that get up to speed.
static void belts(void **state)
{
    (void)state;
    for (int k = 0; k < 4; ++k) {
        const plumb_body_type type = k % 2 == 0 ? PLUMB_KINEMATIC : PLUMB_DYNAMIC;
        const double down = k < 2 ? 1 : -1; // y points up, or down: on a screen all looks the same
        plumb_world *world = NULL;
        const plumb_world_desc desc = { .y_axis = k < 2 ? PLUMB_Y_UP : PLUMB_Y_DOWN };
        assert_int_equal(plumb_world_create(&desc, &world), PLUMB_OK);
        plumb_material rubber =
            plumb_material_create(world, &(plumb_material_desc){ .surface_speed = 2 });
        plumb_body floor = add_box(world, PLUMB_KINEMATIC, V(0, -down), V(100, 1));
        plumb_shape top;
        plumb_body_shapes(world, floor, &top, 1);
        assert_int_equal(plumb_shape_set_material(world, top, rubber), PLUMB_OK);
        plumb_body crate = add_box(world, PLUMB_DYNAMIC, V(30, down / 2), V(0.5, 0.5));
        const plumb_character_desc free_in_air = { .no_air_control = true };
        plumb_body hero = add_hero_of(world, type, V(0, down * (STANDS + SKIN)), &free_in_air);
        run(world, 60, 2);
        assert_near(x_of(world, hero), 4, 0.15);
        assert_near(state_of(world, hero).ground_velocity.x, 2, ROUNDED(1e-4));
        assert_near(plumb_body_velocity(world, crate).x, 2, ROUNDED(1e-3));
        plumb_body_set_velocity(world, floor, V(1, 0));
        double x = x_of(world, hero);
        run(world, 60, 2);
        assert_near(x_of(world, hero) - x, 6, 0.1);
        plumb_character_walk(world, hero, -3); // against both: on the spot
        run(world, 60, 1);
        x = x_of(world, hero);
        run(world, 60, 2);
        assert_near(x_of(world, hero), x, 0.01);
        plumb_character_walk(world, hero, 0);
        run(world, 60, 1);
        assert_true(plumb_character_jump(world, hero, 5)); // it takes the speed along
        run(world, 60, 0.5);
        assert_near(state_of(world, hero).velocity.x, 3, ROUNDED(1e-2));
        plumb_world_destroy(world);
    }
}

static void turning_platforms(void **state)
{
    (void)state;
    for (int k = 0; k < STEP_RATES; ++k) {
        plumb_world *world = make_world();
        plumb_body plate = add_box(world, PLUMB_KINEMATIC, V(0, -0.2), V(3, 0.2));
        plumb_body hero = add_hero(world, 2, 0, NULL);
        run(world, step_rates[k], 0.1);
        for (int i = 0; i < (int)(5 * step_rates[k]); ++i) {
            plumb_body_set_angular_velocity(world, plate, R(0.6 * cos(2 * i / step_rates[k])));
            run(world, step_rates[k], 1 / step_rates[k]);
            assert_true(state_of(world, hero).on_ground);
        }
        plumb_character_state s = state_of(world, hero);
        plumb_vec2 foot = plumb_body_local_point(world, plate, s.ground_point);
        // As the plate tilts, the place where a round foot touches it rolls to and fro by R sin a.
        assert_near(foot.x, 2, (RADIUS + SKIN) * sin(0.31));
        assert_near(foot.y, 0.2, ROUNDED(1e-4));
        assert_near(s.ground_spin, 0.6 * cos(2 * (5 - 1 / step_rates[k])), ROUNDED(1e-3));
        plumb_world_destroy(world);
        // A gondola at the end of an arm that turns at 1 rad/s: round and round with it.
        world = make_world();
        plumb_body wheel = add_body(world, PLUMB_KINEMATIC, V(0, 0));
        plumb_shape_create(world, wheel, &(plumb_shape_desc){ .kind = PLUMB_CIRCLE, .radius = 4 });
        hero = add_hero(world, 0, 4, NULL);
        run(world, step_rates[k], 0.1);
        plumb_body_set_angular_velocity(world, wheel, R(-0.2));
        run(world, step_rates[k], 2);
        s = state_of(world, hero);
        foot = plumb_body_local_point(world, wheel, s.ground_point);
        assert_true(s.on_ground);
        // The foot itself does not turn: carried without slip, it goes round by w R / (R + r).
        assert_near(atan2((double)s.ground_point.x, (double)s.ground_point.y),
                    0.4 * 4 / (4 + RADIUS + SKIN), 1e-3);
        plumb_world_destroy(world);
    }
}

// It takes the platform's velocity along when it jumps off, and walks relative to it, with control in the air or without.
static void off_a_platform(void **state)
{
    (void)state;
    for (int i = 0; i < 2 * STEP_RATES; ++i) {
        const int k = i / 2;
        plumb_world *world = make_world();
        plumb_body lift = add_box(world, PLUMB_KINEMATIC, V(0, -0.2), V(4, 0.2));
        plumb_body hero =
            add_hero(world, 0, 0, &(plumb_character_desc){ .no_air_control = i % 2 == 1 });
        run(world, step_rates[k], 0.1);
        plumb_body_set_velocity(world, lift, V(2, 1));
        run(world, step_rates[k], 0.5);
        plumb_character_walk(world, hero, 1);
        run(world, step_rates[k], 0.5);
        assert_near(x_of(world, hero), 2 + 0.5, ROUNDED(1e-4));
        assert_true(plumb_character_jump(world, hero, 5));
        double x = x_of(world, hero), y = y_of(world, hero);
        run(world, step_rates[k], 0.5);
        assert_near(x_of(world, hero) - x, 1.5, ROUNDED(1e-4));
        assert_near(y_of(world, hero) - y, 6 * 0.5 - 9.81 / 8, ROUNDED(1e-4));
        plumb_world_destroy(world);
    }
}

// Whoever walks off an edge keeps it as well; a wall stops it for good, and the next ground is another one.
static void what_it_left_is_kept_until_it_lands(void **state)
{
    (void)state;
    for (int k = 0; k < STEP_RATES; ++k) {
        plumb_world *world = make_world();
        plumb_body lift = add_box(world, PLUMB_KINEMATIC, V(0, 4.8), V(1, 0.2));
        add_box(world, PLUMB_STATIC, V(0, -0.2), V(40, 0.2));
        add_box(world, PLUMB_STATIC, V(8, 5), V(1, 5));
        plumb_body hero = add_hero(world, 0, 5, NULL);
        run(world, step_rates[k], 0.1);
        plumb_body_set_velocity(world, lift, V(2, 0));
        plumb_character_walk(world, hero, 1);
        run(world, step_rates[k], 1.5); // off it after about 1 s, on its way for another
        assert_false(state_of(world, hero).on_ground);
        assert_near(x_of(world, hero), 4.5, 0.1);
        run(world, step_rates[k], 1);
        assert_true(state_of(world, hero).on_ground);
        // It jumps from ground that stands: as it walks.
        plumb_character_walk(world, hero, -1);
        run(world, step_rates[k], 0.1);
        assert_true(plumb_character_jump(world, hero, 4));
        const double from = x_of(world, hero);
        run(world, step_rates[k], 0.5);
        assert_near(x_of(world, hero), from - 0.5, 1e-3);
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
    for (int k = 0; k < STEP_RATES; ++k) {
        for (int tenth = -5; tenth <= 5; ++tenth) {
            plumb_world *world = make_world();
            add_floor(world);
            add_plank(world, PLUMB_STATIC, V(0, 1.5));
            plumb_body hero = add_hero(world, 0, 0, NULL);
            run(world, step_rates[k], 0.1);
            double top = 1.5 + 0.1 * tenth + 0.03, v = sqrt(2 * 9.81 * top);
            plumb_character_jump(world, hero, R(v));
            double landing = top > 1.5 ? (v + sqrt(v * v - 2 * 9.81 * 1.5)) / 9.81 : 2 * v / 9.81;
            int steps = (int)(landing * step_rates[k]);
            for (int i = 1; i <= steps; ++i) {
                double t = i / step_rates[k];
                run(world, step_rates[k], 1 / step_rates[k]);
                assert_near(feet_of(world, hero), v * t - 9.81 / 2 * t * t, ROUNDED(1e-4));
            }
            run(world, step_rates[k], 0.5);
            assert_near(feet_of(world, hero), top > 1.5 ? 1.5 : 0, ROUNDED(1e-4));
            assert_true(state_of(world, hero).on_ground);
            plumb_world_destroy(world);
        }
    }
}

static void one_way_carries_and_drops(void **state)
{
    (void)state;
    for (int k = 0; k < STEP_RATES; ++k) {
        plumb_world *world = make_world();
        add_floor(world);
        plumb_body plank = add_plank(world, PLUMB_KINEMATIC, V(0, 2));
        plumb_body other = add_plank(world, PLUMB_STATIC, V(0, 1));
        plumb_body hero = add_hero(world, 0, 2, NULL);
        plumb_body_set_velocity(world, plank, V(0.5, 0.5));
        run(world, step_rates[k], 1);
        plumb_vec2 at = plumb_body_local_point(world, plank, plumb_body_position(world, hero));
        assert_near(at.y, STANDS + SKIN, ROUNDED(1e-4));
        assert_true(plumb_same(state_of(world, hero).ground_body, plank));
        assert_true(plumb_character_drop(world, hero));
        assert_false(plumb_character_drop(world, hero)); // in the air by now
        run(world, step_rates[k], 1.5);
        assert_true(plumb_same(state_of(world, hero).ground_body, other));
        assert_near(feet_of(world, hero), 1, ROUNDED(1e-4));
        assert_true(plumb_character_drop(world, hero));
        run(world, step_rates[k], 1.5);
        assert_near(feet_of(world, hero), 0, ROUNDED(1e-4));
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
    assert_near(x_of(world, hero), 5, ROUNDED(1e-3));
    assert_near(feet_of(world, hero), 0, ROUNDED(1e-5));
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
    for (int k = 0; k < STEP_RATES; ++k) {
        plumb_world *world = make_world();
        add_floor(world);
        plumb_body crate = add_crate(world, 2, 40); // friction 0.6: 235 N of 700 N
        plumb_body hero = add_hero(world, 0, 0, NULL);
        plumb_character_walk(world, hero, 2);
        run(world, step_rates[k], 2);
        double x = x_of(world, crate);
        run(world, step_rates[k], 2);
        assert_near(x_of(world, crate) - x, 4, ROUNDED(1e-3));
        assert_near(x_of(world, crate) - x_of(world, hero), 0.5 + RADIUS, 0.08);
        assert_true(state_of(world, hero).at_wall);
        plumb_world_destroy(world);
    }
}

// Against a kinematic body there is nothing to be done: it is pushed, or squeezed.
static void is_pushed(void **state)
{
    (void)state;
    for (int k = 0; k < STEP_RATES; ++k) {
        plumb_world *world = make_world();
        add_floor(world);
        plumb_body wall = add_box(world, PLUMB_KINEMATIC, V(-2, 1.1), V(0.5, 1));
        plumb_body hero = add_hero(world, 0, 0, NULL);
        plumb_body_set_velocity(world, wall, V(3, 0));
        run(world, step_rates[k], 2);
        assert_near(x_of(world, hero) - x_of(world, wall), 0.5 + RADIUS + SKIN, ROUNDED(1e-3));
        assert_true(state_of(world, hero).on_ground);
        assert_false(state_of(world, hero).crushed);
        add_box(world, PLUMB_STATIC, V(x_of(world, hero) + 2, 1.1), V(0.5, 1));
        bool crushed = false;
        for (int i = 0; i < (int)(step_rates[k]); ++i) {
            run(world, step_rates[k], 1 / step_rates[k]);
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
    assert_near(x_of(world, b) - x_of(world, a), 2 * RADIUS + SKIN, ROUNDED(0.02));
    assert_near(x_of(world, a) + x_of(world, b), 0, 0.1);
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
        assert_near(x_of(world, low), 7, ROUNDED(1e-3));
        assert_near(x_of(world, high), 7, ROUNDED(1e-3));
    }
    plumb_world_destroy(world);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(moving_platforms),
        cmocka_unit_test(belts),
        cmocka_unit_test(turning_platforms),
        cmocka_unit_test(off_a_platform),
        cmocka_unit_test(what_it_left_is_kept_until_it_lands),
        cmocka_unit_test(one_way_from_below),
        cmocka_unit_test(one_way_carries_and_drops),
        cmocka_unit_test(one_way_from_the_side),
        cmocka_unit_test(pushes_crates),
        cmocka_unit_test(is_pushed),
        cmocka_unit_test(characters_meet),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
