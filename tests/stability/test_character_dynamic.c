// test_character_dynamic.c - dynamic characters: driven by forces, pushed by everything.
#include "walker.h"

static plumb_body add_walker(plumb_world *world, double x, double y, const plumb_character_desc *d)
{
    return add_hero_of(world, PLUMB_DYNAMIC, V(x, y + STANDS), d);
}

static const double rates[] = { 30, 60, 120, 240 };
#define RATES ((int)(sizeof rates / sizeof rates[0]))

static void walks_at_its_speed(void **state)
{
    (void)state;
    for (int k = 0; k < RATES; ++k) {
        plumb_world *world = make_world();
        add_floor(world);
        plumb_body hero = add_walker(world, 0, 0, &(plumb_character_desc){ .acceleration = 10 });
        run(world, rates[k], 1);
        plumb_character_walk(world, hero, 3);
        run(world, rates[k], 2); // 0.3 s to reach it: 0.45 m, then 1.7 s
        assert_near(x_of(world, hero), 0.45 + 5.1, 0.06);
        assert_near(state_of(world, hero).velocity.x, 3, ROUNDED(1e-3));
        plumb_character_walk(world, hero, 0);
        run(world, rates[k], 1);
        assert_near(state_of(world, hero).velocity.x, 0, ROUNDED(1e-3));
        assert_near(x_of(world, hero), 0.45 + 5.1 + 0.45, ROUNDED(0.1));
        assert_true(state_of(world, hero).on_ground);
        assert_near(plumb_body_angle(world, hero), 0, ROUNDED(1e-6));
        plumb_world_destroy(world);
    }
}

static void slopes(void **state)
{
    (void)state;
    for (int k = 0; k < RATES; ++k) {
        const plumb_vec2 hill[] = { { -30, 0 }, { 0, 0 }, { 20, 12 } }; // 31 degrees
        plumb_world *world = make_world();
        add_chain(world, hill, 3);
        plumb_body hero = add_walker(world, 5, 3.3, NULL);
        run(world, rates[k], 2);
        plumb_vec2 p = plumb_body_position(world, hero);
        run(world, rates[k], 5); // it stands: creep below 0.1 mm/s
        assert_near(plumb_vec2_distance(p, plumb_body_position(world, hero)), 0, ROUNDED(5e-4));
        plumb_character_walk(world, hero, 2);
        run(world, rates[k], 2);
        assert_near(plumb_vec2_distance(p, plumb_body_position(world, hero)), 4, 0.1);
        plumb_character_walk(world, hero, 0);
        run(world, rates[k], 0.5);
        plumb_character_set(world, hero, &(plumb_character_desc){ .max_slope = R(0.4) });
        p = plumb_body_position(world, hero);
        run(world, rates[k], 1);
        assert_true(state_of(world, hero).on_slope && !state_of(world, hero).on_ground);
        assert_near(y_of(world, hero) - (double)p.y, -9.81 / 2 * 0.2647, 0.1); // g sin^2 a / 2 t^2
        plumb_world_destroy(world);
    }
}

static void jumps(void **state)
{
    (void)state;
    for (int k = 0; k < RATES; ++k) {
        plumb_world *world = make_world();
        add_floor(world);
        plumb_body hero = add_walker(world, 0, 0, NULL);
        run(world, rates[k], 1);
        plumb_character_walk(world, hero, 2);
        run(world, rates[k], 1);
        double x = x_of(world, hero), y = y_of(world, hero);
        assert_true(plumb_character_jump(world, hero, 6));
        for (int i = 1; i < (int)(rates[k]); ++i) {
            double t = i / rates[k];
            run(world, rates[k], 1 / rates[k]);
            assert_near(y_of(world, hero) - y, 6 * t - 9.81 / 2 * t * t, ROUNDED(2e-3));
            assert_near(x_of(world, hero) - x, 2 * t, ROUNDED(2e-3));
            assert_false(plumb_character_jump(world, hero, 6));
        }
        plumb_world_destroy(world);
    }
}

// Whoever stood long enough to fall asleep jumps as high as anybody, off the ground and off a crate that sleeps below.
static void jumps_out_of_sleep(void **state)
{
    (void)state;
    for (int on_crate = 0; on_crate < 2; ++on_crate) {
        for (int put = 0; put < 2;
             ++put) { // asleep when the jump is ordered, and put to sleep after that
            plumb_world *world = make_world();
            add_floor(world);
            if (on_crate) {
                plumb_body crate = add_box(world, PLUMB_DYNAMIC, V(0, 0.5), V(0.5, 0.5));
                assert_int_equal(plumb_body_set_mass(world, crate, 100), PLUMB_OK);
            }
            plumb_body hero = add_walker(world, 0, on_crate, NULL);
            run(world, 60, put ? 0.25 : 3);
            assert_int_equal(plumb_body_is_awake(world, hero), put);
            double y = y_of(world, hero), top = y;
            assert_true(plumb_character_jump(world, hero, 6));
            if (put) {
                assert_int_equal(plumb_body_sleep(world, hero), PLUMB_OK);
            }
            for (int i = 0; i < 60; ++i) {
                run(world, 60, 1.0 / 60);
                top = y_of(world, hero) > top ? y_of(world, hero) : top;
            }
            assert_near(top - y, 6 * 6 / (2 * 9.81), 0.01);
            run(world, 60, 1);
            assert_true(state_of(world, hero).on_ground);
            plumb_world_destroy(world);
        }
    }
}

static void in_the_air(void **state)
{
    (void)state;
    plumb_world *world = make_world();
    const plumb_character_desc desc = { .air_acceleration = 2 };
    plumb_body a = add_walker(world, 0, 0, &desc);
    plumb_body b = add_walker(world, 5, 0, &(plumb_character_desc){ .no_air_control = true });
    plumb_character_walk(world, a, 3);
    plumb_character_walk(world, b, 3);
    run(world, 60, 1);
    assert_near(x_of(world, a), 1, ROUNDED(1e-3));
    assert_near(x_of(world, b), 5, ROUNDED(1e-6));
    assert_true(state_of(world, a).air_time > 0.99f);
    plumb_world_destroy(world);
}

static void platforms(void **state)
{
    (void)state;
    for (int k = 0; k < RATES; ++k) {
        plumb_world *world = make_world();
        plumb_body lift = add_box(world, PLUMB_KINEMATIC, V(0, -0.2), V(3, 0.2));
        plumb_body hero = add_walker(world, 0, 0, NULL);
        run(world, rates[k], 1);
        for (int i = 0; i < (int)(4 * rates[k]); ++i) {
            plumb_body_set_velocity(world, lift, V(2 * sin(i / rates[k]), cos(i / rates[k])));
            run(world, rates[k], 1 / rates[k]);
        }
        plumb_vec2 at = plumb_body_local_point(world, lift, plumb_body_position(world, hero));
        assert_near(at.x, 0, 0.12); // it follows one step behind
        assert_near(at.y, 0.2 + STANDS, 0.02);
        // In the air it goes on with what the platform had.
        plumb_body_set_velocity(world, lift, V(2, 0));
        run(world, rates[k], 0.5);
        const double on_it = x_of(world, hero) - x_of(world, lift);
        assert_true(plumb_character_jump(world, hero, 4));
        run(world, rates[k], 0.5);
        assert_false(state_of(world, hero).on_ground);
        assert_near(x_of(world, hero) - x_of(world, lift), on_it, 0.05);
        plumb_world_destroy(world);
    }
}

// Its mass counts: what it walks on goes the other way, what it pushes goes along.
static void action_and_reaction(void **state)
{
    (void)state;
    plumb_world *world = make_world();
    plumb_material ice =
        plumb_material_create(world, &(plumb_material_desc){ .density = 20, .frictionless = true });
    plumb_body ground = add_body(world, PLUMB_STATIC, V(0, -2));
    plumb_body raft = add_body(world, PLUMB_DYNAMIC, V(0, -0.5));
    plumb_shape_create(
        world, ground,
        &(plumb_shape_desc){ .kind = PLUMB_BOX, .half = { 50, 1 }, .material = ice });
    plumb_shape_create(
        world, raft,
        &(plumb_shape_desc){ .kind = PLUMB_BOX, .half = { 4, R(0.5) }, .material = ice });
    plumb_body hero = add_walker(world, 0, 0, NULL);
    run(world, 60, 0.5);
    plumb_character_walk(world, hero, 1.5f);
    run(world, 60, 1);
    double p = (double)(plumb_body_mass(world, hero) * plumb_body_velocity(world, hero).x +
                        plumb_body_mass(world, raft) * plumb_body_velocity(world, raft).x);
    assert_near(p, 0, 1.5);
    assert_near(plumb_body_velocity(world, hero).x - plumb_body_velocity(world, raft).x, 1.5,
                ROUNDED(0.02));
    assert_true((double)plumb_body_velocity(world, raft).x < -0.1);
    plumb_world_destroy(world);
}

static void drops_and_flies(void **state)
{
    (void)state;
    plumb_world *world = make_world();
    add_floor(world);
    plumb_body plank = add_body(world, PLUMB_STATIC, V(0, 2));
    plumb_shape_create(world, plank,
                       &(plumb_shape_desc){
                           .kind = PLUMB_BOX, .half = { 2, R(0.1) }, .one_way = { { 0, 1 }, 0 } });
    plumb_body hero = add_walker(world, 0, 2.1, NULL);
    run(world, 60, 0.5);
    assert_near(y_of(world, hero), 2.1 + STANDS, 2e-3);
    assert_true(plumb_character_drop(world, hero));
    run(world, 60, 1.5);
    assert_near(y_of(world, hero), STANDS, 2e-3);
    assert_false(plumb_character_drop(world, hero));
    plumb_character_fly(world, hero, V(1, 2));
    run(world, 60, 2);
    assert_near(x_of(world, hero), 2, 0.05);
    assert_near(y_of(world, hero), STANDS + 4, 0.1);
    plumb_character_set_velocity(world, hero, V(-3, 0));
    assert_near(plumb_body_velocity(world, hero).x, -3, ROUNDED(1e-6));
    plumb_world_destroy(world);
}

// Put to sleep half way through a plank, and told to walk: the plank lets pass, awake or not.
static void passes_out_of_sleep(void **state)
{
    (void)state;
    for (int k = 0; k < 40; ++k) {
        plumb_world *world = make_world();
        add_floor(world);
        plumb_body plank = add_body(world, PLUMB_STATIC, V(0, 1));
        plumb_shape_create(world, plank,
                           &(plumb_shape_desc){ .kind = PLUMB_BOX,
                                                .half = { 2, R(0.1) },
                                                .one_way = { { 0, 1 }, 0 } });
        plumb_body hero = add_walker(world, 0, 1.1, NULL);
        run(world, 60, 0.5);
        assert_true(plumb_character_drop(world, hero));
        run(world, 60, (1 + k) / 60.0);
        assert_int_equal(plumb_body_sleep(world, hero), PLUMB_OK);
        assert_int_equal(plumb_character_walk(world, hero, 1), PLUMB_OK);
        run(world, 60, 1.0 / 60);
        assert_true(!state_of(world, hero).on_ground || y_of(world, hero) < STANDS + 0.04);
        run(world, 60, 1);
        assert_near(y_of(world, hero), STANDS, 2e-3);
        plumb_world_destroy(world);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(walks_at_its_speed),
        cmocka_unit_test(slopes),
        cmocka_unit_test(jumps),
        cmocka_unit_test(jumps_out_of_sleep),
        cmocka_unit_test(in_the_air),
        cmocka_unit_test(platforms),
        cmocka_unit_test(action_and_reaction),
        cmocka_unit_test(drops_and_flies),
        cmocka_unit_test(passes_out_of_sleep),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
