// test_character.c - characters: steps of any length, slopes, ground of many pieces.
#include "walker.h"

//---- the length of a step does not matter -------------------------------------------------------

// Hills, stairs up and down, a wall of tiles: 37 m.
static void a_course(void **state)
{
    (void)state;
    double least = HUGE_VAL, most = -HUGE_VAL;
    const plumb_vec2 hills[] = { { -20, 0 }, { 5, 0 },  { 9, 2 },  { 13, 2 }, { 17, 0 },
                                 { 21, 0 },  { 25, 3 }, { 29, 3 }, { 60, 3 } };
    for (int k = 0; k < STEP_RATES; ++k) {
        plumb_world *world = make_world();
        add_chain(world, hills, 9);
        for (int i = 0; i < 4; ++i) { // 0.2 m each, down on the other side in one flight of stairs
            add_box(world, PLUMB_STATIC, V(31, 3.1 + 0.2 * i), V(1.6 - 0.35 * i, 0.1));
        }
        plumb_body hero = add_hero(world, 0, 0, NULL);
        plumb_character_walk(world, hero, 3);
        run(world, step_rates[k], 13);
        plumb_character_state s = state_of(world, hero);
        assert_true(s.on_ground && !s.at_wall);
        assert_near(feet_of(world, hero), 3, ROUNDED(1e-5));
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
    for (int k = 0; k < STEP_RATES; ++k) {
        plumb_world *world = make_world();
        add_floor(world);
        plumb_body hero = add_hero(world, -5, 0, NULL);
        plumb_character_walk(world, hero, 3);
        run(world, step_rates[k], 0.5);
        assert_near(x_of(world, hero), -3.5, ROUNDED(1e-5));
        assert_true(plumb_character_jump(world, hero, 6));
        double landing = 2 * 6 / 9.81, highest = 0;
        int steps = (int)(landing * step_rates[k]);
        for (int i = 1; i <= steps; ++i) {
            double t = i / step_rates[k];
            run(world, step_rates[k], 1 / step_rates[k]);
            assert_near(feet_of(world, hero), 6 * t - 9.81 / 2 * t * t, ROUNDED(5e-5));
            assert_near(x_of(world, hero), -3.5 + 3 * t, ROUNDED(5e-5));
            highest = fmax(highest, feet_of(world, hero));
            assert_false(state_of(world, hero).on_ground);
            assert_false(plumb_character_jump(world, hero, 6)); // not in the air
        }
        assert_near(highest, 6 * 6 / (2 * 9.81), 9.81 / (8 * step_rates[k] * step_rates[k]) + 1e-4);
        run(world, step_rates[k], 1.5 - steps / step_rates[k]);
        assert_true(state_of(world, hero).on_ground);
        assert_near(x_of(world, hero), -3.5 + 4.5, ROUNDED(1e-4));
        assert_near(feet_of(world, hero), 0, ROUNDED(1e-5));
        plumb_world_destroy(world);
    }
}

// From platform to platform: over gaps, through one-way planks, down again. Orders at half seconds.
static void a_tour_of_jumps(void **state)
{
    (void)state;
    double least = HUGE_VAL, most = -HUGE_VAL;
    for (int k = 0; k < STEP_RATES; ++k) {
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
        run(world, step_rates[k], 0.5); // x = 2
        assert_true(plumb_character_jump(world, hero, 7));
        run(world, step_rates[k], 1.5); // over the gap, x = 8
        assert_true(plumb_character_jump(world, hero, 7));
        run(world, step_rates[k], 1.5); // x = 14, up on the plank
        assert_near(feet_of(world, hero), 1.6, ROUNDED(1e-4));
        plumb_character_walk(world, hero, 1);
        assert_true(plumb_character_drop(world, hero));
        run(world, step_rates[k], 1.5);
        assert_near(feet_of(world, hero), 0, ROUNDED(1e-4));
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
        assert_near(plumb_vec2_distance(p, plumb_body_position(world, hero)), 0, ROUNDED(1e-6));
        plumb_character_walk(world, hero, 3); // 3 m/s along the slope, up and down
        run(world, 60, 2);
        assert_near(plumb_vec2_distance(p, plumb_body_position(world, hero)), 6, ROUNDED(1e-3));
        plumb_character_walk(world, hero, -3);
        run(world, 60, 2);
        assert_near(plumb_vec2_distance(p, plumb_body_position(world, hero)), 0, ROUNDED(2e-3));
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
    assert_near(plumb_vec2_magnitude(state_of(world, hero).velocity) - R(v0), 9.81 * sin(a) * 0.25,
                ROUNDED(1e-2));
    plumb_world_destroy(world);
    for (int k = 0; k < STEP_RATES; ++k) {
        world = make_world();
        add_chain(world, hill, 3);
        hero = add_hero(world, -3, 0, NULL);
        plumb_character_walk(world, hero, 5);
        double highest = 0;
        for (int i = 0; i < (int)(3 * step_rates[k]); ++i) {
            run(world, step_rates[k], 1 / step_rates[k]);
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
static void internal_edges(void **state)
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
                    assert_near(x_of(world, hero) - x, side * 0.05, 1e-5);
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
    assert_near(x_of(world, hero), 1, 1e-4);
    assert_near(feet_of(world, hero), -9.81 / 2 * t * t, 2e-3);
    plumb_world_destroy(world);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_course),        cmocka_unit_test(jumps_are_exact),
        cmocka_unit_test(a_tour_of_jumps), cmocka_unit_test(slopes),
        cmocka_unit_test(too_steep),       cmocka_unit_test(between_two_slopes_it_stands),
        cmocka_unit_test(internal_edges),  cmocka_unit_test(uphill_over_corners),
        cmocka_unit_test(edges),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
