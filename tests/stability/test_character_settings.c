// test_character_settings.c - every setting of a character does what it says: the same scene twice,
// once with it and once without. No setting is without effect.
#include "walker.h"

// A hero who walks to the right from x = 0 on a floor, with things in the way.
typedef void prepare_fn(plumb_world *world);

static plumb_world *walk_in(const plumb_character_desc *desc, prepare_fn *prepare, double speed,
                            double seconds, plumb_body *hero)
{
    plumb_world *world = make_world();
    add_floor(world);
    if (prepare != NULL) {
        prepare(world);
    }
    *hero = add_hero(world, 0, 0, desc);
    plumb_character_walk(world, *hero, R(speed));
    run(world, 60, seconds);
    return world;
}

// Where it comes to.
static double way_of(const plumb_character_desc *desc, prepare_fn *prepare, double speed,
                     double seconds)
{
    plumb_body hero;
    plumb_world *world = walk_in(desc, prepare, speed, seconds, &hero);
    double x = x_of(world, hero);
    plumb_world_destroy(world);
    return x;
}

static void ramp(plumb_world *world) // 35 degrees
{
    const plumb_vec2 points[] = { { 2, 0 }, V(22, 20 * 0.70020754) };
    add_chain(world, points, 2);
}

static void step_of_30_cm(plumb_world *world)
{
    add_box(world, PLUMB_STATIC, V(7, 0.15), V(5, 0.15));
}

static void post_of_5_cm(plumb_world *world)
{
    add_box(world, PLUMB_STATIC, V(2, 0.15), V(0.025, 0.15));
}

static void crate_of_40_kg(plumb_world *world)
{
    plumb_body crate = add_box(world, PLUMB_DYNAMIC, V(2, 0.5), V(0.5, 0.5));
    plumb_body_set_mass(world, crate, 40);
}

static void max_slope(void **state)
{
    (void)state;
    assert_true(way_of(NULL, ramp, 3, 2) > 4.5);
    assert_true(way_of(&(plumb_character_desc){ .max_slope = R(0.5) }, ramp, 3, 2) < 2.2);
    assert_true(way_of(&(plumb_character_desc){ .max_slope = R(0.62) }, ramp, 3, 2) > 4.5);
}

static void steps(void **state)
{
    (void)state;
    assert_true(way_of(NULL, step_of_30_cm, 3, 2) > 5); // default: 0.45 m
    assert_true(way_of(&(plumb_character_desc){ .step_height = R(0.31) }, step_of_30_cm, 3, 2) > 5);
    assert_true(way_of(&(plumb_character_desc){ .step_height = R(0.29) }, step_of_30_cm, 3, 2) < 2);
    assert_true(way_of(&(plumb_character_desc){ .no_steps = true }, step_of_30_cm, 3, 2) < 2);
    assert_true(way_of(NULL, post_of_5_cm, 3, 2) < 2); // default: 7.5 cm
    assert_true(way_of(&(plumb_character_desc){ .step_width = R(0.04) }, post_of_5_cm, 3, 2) > 3);
}

// Off a step of 0.3 m: followed down, or fallen from.
static int steps_in_the_air(const plumb_character_desc *desc)
{
    plumb_world *world = make_world();
    add_floor(world);
    add_box(world, PLUMB_STATIC, V(0, 0.15), V(1, 0.15));
    plumb_body hero = add_hero(world, 0, 0.3, desc);
    plumb_character_walk(world, hero, 3);
    int count = 0;
    for (int i = 0; i < 120; ++i) {
        run(world, 60, 1.0 / 60);
        count += !state_of(world, hero).on_ground;
    }
    assert_near(feet_of(world, hero), 0, ROUNDED(1e-4));
    plumb_world_destroy(world);
    return count;
}

static void snapping(void **state)
{
    (void)state;
    assert_int_equal(steps_in_the_air(NULL), 0);
    assert_true(steps_in_the_air(&(plumb_character_desc){ .snap_distance = R(0.2) }) > 5);
    assert_int_equal(steps_in_the_air(&(plumb_character_desc){ .snap_distance = R(0.35) }), 0);
    assert_true(steps_in_the_air(&(plumb_character_desc){ .no_snap = true }) > 5);
    // Without a distance of its own it is that of steps.
    assert_true(steps_in_the_air(&(plumb_character_desc){ .step_height = R(0.2) }) > 5);
}

static void skin(void **state)
{
    (void)state;
    for (int k = 0; k < 2; ++k) {
        double wanted = k ? 0.05 : SKIN;
        plumb_body hero;
        const plumb_character_desc desc = { .skin = R(k ? wanted : 0) };
        plumb_world *world = make_world();
        add_floor(world);
        add_box(world, PLUMB_STATIC, V(3, 1), V(1, 1));
        hero = add_hero(world, 0, 0.2, &desc);
        plumb_character_walk(world, hero, 2);
        run(world, 60, 2);
        assert_near(y_of(world, hero) - STANDS, wanted, ROUNDED(1e-5));
        assert_near(2 - RADIUS - x_of(world, hero), wanted, ROUNDED(1e-5));
        plumb_world_destroy(world);
    }
}

// x = a t^2 / 2 till the speed is reached, at any rate; the same when it slows down.
static void acceleration(void **state)
{
    (void)state;
    for (int k = 0; k < STEP_RATES; ++k) {
        plumb_world *world = make_world();
        add_floor(world);
        plumb_body hero = add_hero(world, 0, 0, &(plumb_character_desc){ .acceleration = 5 });
        run(world, step_rates[k], 0.5);
        plumb_character_walk(world, hero, 4);
        run(world, step_rates[k], 0.5);
        assert_near(x_of(world, hero), 5 * 0.25 / 2, ROUNDED(1e-4));
        run(world, step_rates[k], 1);
        assert_near(x_of(world, hero), 4 * 0.8 / 2 + 4 * 0.7, ROUNDED(1e-4));
        plumb_character_walk(world, hero, 0);
        run(world, step_rates[k], 1);
        assert_near(x_of(world, hero), 4 * 0.8 / 2 + 4 * 0.7 + 4 * 0.8 / 2, ROUNDED(2e-4));
        plumb_world_destroy(world);
    }
}

// Sideways way of a jump that turns round at its start: v t - a t^2 / 2, or none of it.
static double turned_jump(const plumb_character_desc *desc)
{
    plumb_body hero;
    plumb_world *world = walk_in(desc, NULL, 3, 1, &hero);
    double x = x_of(world, hero);
    assert_true(plumb_character_jump(world, hero, 5));
    plumb_character_walk(world, hero, -3);
    run(world, 60, 0.5);
    x = x_of(world, hero) - x;
    plumb_world_destroy(world);
    return x;
}

static void in_the_air(void **state)
{
    (void)state;
    assert_near(turned_jump(NULL), -1.5, ROUNDED(1e-4));
    assert_near(turned_jump(&(plumb_character_desc){ .air_acceleration = 4 }), 1.5 - 4 * 0.125,
                ROUNDED(1e-4));
    assert_near(turned_jump(&(plumb_character_desc){ .acceleration = 8 }), 1.5 - 8 * 0.125,
                ROUNDED(1e-4));
    assert_near(turned_jump(&(plumb_character_desc){ .no_air_control = true }), 1.5, ROUNDED(1e-4));
}

static void max_fall_speed(void **state)
{
    (void)state;
    for (int k = 0; k < 2; ++k) {
        plumb_world *world = make_world();
        const plumb_character_desc desc = { .max_fall_speed = R(k ? 2 : 0) };
        plumb_body hero = add_hero(world, 0, 0, &desc);
        run(world, 60, 1);
        double v = 9.81, t = 2 / 9.81;
        assert_near(state_of(world, hero).velocity.y, k ? -2 : -v, ROUNDED(1e-4));
        assert_near(feet_of(world, hero), k ? -t * 2 / 2 - (1 - t) * 2 : -v / 2, ROUNDED(1e-4));
        plumb_world_destroy(world);
    }
}

// A plank on a pivot, a crate on its other end: who is heavy enough lifts it.
static double angle_of_seesaw(const plumb_character_desc *desc)
{
    plumb_world *world = make_world();
    plumb_body plank = add_box(world, PLUMB_DYNAMIC, V(0, 1), V(3, 0.1));
    plumb_body_set_mass(world, plank, 5);
    plumb_joint_create(world, &(plumb_joint_desc){ .kind = PLUMB_REVOLUTE,
                                                   .body_b = plank,
                                                   .anchor = { 0, 1 },
                                                   .enable_limit = true,
                                                   .lower = R(-0.3),
                                                   .upper = R(0.3) });
    plumb_body crate = add_box(world, PLUMB_DYNAMIC, V(-2.4, 1.6), V(0.5, 0.5));
    plumb_body_set_mass(world, crate, 40);
    plumb_body hero = add_hero(world, 2.4, 1.1, desc);
    run(world, 60, 4);
    double angle = (double)plumb_body_angle(world, plank);
    assert_true(state_of(world, hero).on_ground || plumb_body_is_character(world, hero));
    plumb_world_destroy(world);
    return angle;
}

static void mass(void **state)
{
    (void)state;
    assert_true(angle_of_seesaw(NULL) < -0.25); // 70 kg
    assert_true(angle_of_seesaw(&(plumb_character_desc){ .mass = 20 }) > 0.25);
}

static void pushing(void **state)
{
    (void)state;
    // Friction holds the crate with 0.6 * 40 * 9.81 = 235 N.
    assert_true(way_of(NULL, crate_of_40_kg, 2, 4) > 6);
    assert_true(way_of(&(plumb_character_desc){ .push_force = 200 }, crate_of_40_kg, 2, 4) < 1.3);
    assert_true(way_of(&(plumb_character_desc){ .push_force = 300 }, crate_of_40_kg, 2, 4) > 3);
    assert_true(way_of(&(plumb_character_desc){ .no_push = true }, crate_of_40_kg, 2, 4) < 1.3);
    // Its default follows the mass: 20 kg push with 200 N.
    assert_true(way_of(&(plumb_character_desc){ .mass = 20 }, crate_of_40_kg, 2, 4) < 1.3);
}

// Up for the character alone: on a wall, in a world that falls to it.
static void up(void **state)
{
    (void)state;
    plumb_world *world = make_world();
    plumb_world_set_gravity(world, V(0, -9.81));
    add_box(world, PLUMB_STATIC, V(0, -1), V(100, 1));
    const plumb_character_desc tilted = { .up = { R(-0.6), R(0.8) } };
    plumb_body hero = add_hero(world, 0, 0, &tilted);
    run(world, 60, 0.5);
    plumb_character_state s = state_of(world, hero);
    assert_near(s.up.x, -0.6, ROUNDED(1e-6));
    assert_near(s.up.y, 0.8, ROUNDED(1e-6));
    assert_true(s.on_ground); // the floor is a slope of 37 degrees to it
    assert_int_equal(
        plumb_character_set(
            world, hero, &(plumb_character_desc){ .up = { R(-0.6), R(0.8) }, .max_slope = R(0.6) }),
        PLUMB_OK);
    run(world, 60, 0.5);
    assert_false(state_of(world, hero).on_ground); // too steep now
    plumb_world_destroy(world);
}

//---- orders -----------------------------------------------------------------------------------------

static void flying(void **state)
{
    (void)state;
    plumb_world *world = make_world();
    add_box(world, PLUMB_STATIC, V(5, 0), V(1, 20));
    plumb_body hero = add_hero(world, 0, 3, &(plumb_character_desc){ .acceleration = 4 });
    double y = y_of(world, hero);
    plumb_character_fly(world, hero, V(0, 0));
    run(world, 60, 1); // no gravity
    assert_near(y_of(world, hero), y, ROUNDED(1e-6));
    plumb_character_fly(world, hero, V(0, 2));
    run(world, 60, 1);
    assert_near(y_of(world, hero), y + 0.5 + 1, ROUNDED(1e-4));
    plumb_character_fly(world, hero, V(3, 2));
    run(world, 60, 4); // along the wall
    assert_near(x_of(world, hero), 4 - RADIUS - SKIN, ROUNDED(1e-4));
    assert_true(y_of(world, hero) > y + 8 && state_of(world, hero).at_wall);
    assert_false(plumb_character_jump(world, hero, 3));
    plumb_character_walk(world, hero, 0);
    run(world, 60, 0.5);
    assert_true((double)state_of(world, hero).velocity.y < 0);
    plumb_world_destroy(world);
}

static void thrown(void **state)
{
    (void)state;
    plumb_world *world = make_world();
    add_floor(world);
    plumb_body hero = add_hero(world, 0, 0, &(plumb_character_desc){ .no_air_control = true });
    run(world, 60, 0.2);
    assert_int_equal(plumb_character_set_velocity(world, hero, V(2, 4)), PLUMB_OK);
    run(world, 60, 0.5);
    assert_near(x_of(world, hero), 1, ROUNDED(1e-4));
    assert_near(feet_of(world, hero), 2 - 9.81 / 8, ROUNDED(1e-4));
    run(world, 60, 1);
    plumb_character_set(world, hero, &(plumb_character_desc){ .acceleration = 2 });
    double x = x_of(world, hero);
    plumb_character_set_velocity(world, hero, V(2, -1)); // along the ground it slows down
    run(world, 60, 2);
    assert_near(x_of(world, hero) - x, 1, ROUNDED(1e-3));
    assert_true(state_of(world, hero).on_ground);
    plumb_world_destroy(world);
}

static void hits(void **state)
{
    (void)state;
    plumb_world *world = make_world();
    plumb_body floor = add_floor(world);
    plumb_body wall = add_box(world, PLUMB_STATIC, V(3, 1), V(1, 1));
    plumb_body hero = add_hero(world, 0, 1, NULL);
    plumb_character_hit list[PLUMB_CHARACTER_HITS];
    bool landed = false, stopped = false;
    plumb_character_walk(world, hero, 2);
    for (int i = 0; i < 120; ++i) {
        run(world, 60, 1.0 / 60);
        int count = plumb_character_hits(world, hero, list, PLUMB_CHARACTER_HITS);
        for (int k = 0; k < count; ++k) {
            if (plumb_same(list[k].body, floor)) {
                assert_false(landed); // once, with the speed of a fall from 1 m
                assert_near(list[k].speed, sqrt(2 * 9.81), 0.17);
                assert_near(list[k].normal.y, 1, ROUNDED(1e-6));
                assert_near(list[k].point.y, 0, ROUNDED(1e-5));
                landed = true;
            } else {
                assert_true(plumb_same(list[k].body, wall));
                assert_near(list[k].normal.x, -1, ROUNDED(1e-6));
                assert_near(list[k].point.x, 2, ROUNDED(1e-5));
                stopped = true;
            }
        }
    }
    assert_true(landed && stopped && state_of(world, hero).at_wall);
    plumb_character_walk(world, hero, -2);
    run(world, 60, 0.1);
    assert_int_equal(plumb_character_hits(world, hero, NULL, 0), 0);
    plumb_world_destroy(world);
}

// Against a crate that it cannot move, or that a wall stops, it stands: its velocity says so, and the ground under it is no hit.
static void pushing_in_vain(void **state)
{
    (void)state;
    for (int heavy = 0; heavy < 2; ++heavy) {
        plumb_world *world = make_world();
        plumb_body floor = add_floor(world);
        plumb_body crate = add_box(world, PLUMB_DYNAMIC, V(2, 0.5), V(0.5, 0.5));
        plumb_body_set_mass(world, crate, heavy ? 5000 : 20);
        add_box(world, PLUMB_STATIC, V(heavy ? 20 : 3.2, 1), V(0.5, 1));
        plumb_body hero = add_hero(world, 0, 0, NULL);
        run(world, 60, 0.5);
        plumb_character_walk(world, hero, 4);
        for (int i = 0; i < 180; ++i) {
            plumb_character_hit list[PLUMB_CHARACTER_HITS];
            run(world, 60, 1.0 / 60);
            const int count = plumb_character_hits(world, hero, list, PLUMB_CHARACTER_HITS);
            for (int k = 0; k < count; ++k) {
                assert_false(plumb_same(list[k].body, floor));
            }
            const double told = (double)state_of(world, hero).velocity.x;
            assert_true(told >= 0 && told <= 4 + 1e-5);
        }
        assert_true(state_of(world, hero).at_wall && state_of(world, hero).on_ground);
        assert_near(state_of(world, hero).velocity.x, 0, heavy ? 0.05 : 0.01);
        plumb_world_destroy(world);
    }
}

static void air_time(void **state)
{
    (void)state;
    plumb_body hero;
    plumb_world *world = walk_in(NULL, NULL, 0, 0.5, &hero);
    assert_true(state_of(world, hero).air_time == 0);
    plumb_character_jump(world, hero, 5);
    run(world, 60, 0.5);
    assert_near(state_of(world, hero).air_time, 0.5, ROUNDED(1e-5));
    run(world, 60, 1);
    assert_true(state_of(world, hero).air_time == 0);
    plumb_world_destroy(world);
}

// A filter that does not let the two meet: it walks through.
static void filters_hold(void **state)
{
    (void)state;
    plumb_world *world = make_world();
    add_floor(world);
    plumb_body wall = add_box(world, PLUMB_STATIC, V(2, 1), V(0.5, 1));
    plumb_body hero = add_hero(world, 0, 0, NULL);
    plumb_shape shape;
    plumb_body_shapes(world, wall, &shape, 1);
    plumb_character_walk(world, hero, 3);
    run(world, 60, 1);
    assert_true(x_of(world, hero) < 1.3);
    plumb_shape_set_filter(world, shape, (plumb_filter){ .nothing = true });
    run(world, 60, 1);
    assert_near(x_of(world, hero), 1.5 - RADIUS - SKIN + 3, ROUNDED(1e-3));
    plumb_world_destroy(world);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(max_slope),
        cmocka_unit_test(steps),
        cmocka_unit_test(snapping),
        cmocka_unit_test(skin),
        cmocka_unit_test(acceleration),
        cmocka_unit_test(in_the_air),
        cmocka_unit_test(max_fall_speed),
        cmocka_unit_test(mass),
        cmocka_unit_test(pushing),
        cmocka_unit_test(up),
        cmocka_unit_test(flying),
        cmocka_unit_test(thrown),
        cmocka_unit_test(hits),
        cmocka_unit_test(air_time),
        cmocka_unit_test(pushing_in_vain),
        cmocka_unit_test(filters_hold),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
