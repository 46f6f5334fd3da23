// test_character_world.c - characters in worlds that turn, change, sleep, and lie far off.
#include "harness/random.h"
#include "walker.h"

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
    assert_near(highest, 2.5 - 2 * STANDS - 2 * SKIN, ROUNDED(1e-3));
    assert_near(feet_of(world, hero), 0, ROUNDED(1e-4));
    plumb_world_destroy(world);
}

// The same walk and jump in a world whose y points down, and in one that falls to the left.
static void which_way_is_up(void **state)
{
    (void)state;
    for (int k = 0; k < 3; ++k) {
        // Right and up of each world.
        const plumb_vec2 right[] = { { 1, 0 }, { 1, 0 }, { 0, -1 } };
        const plumb_vec2 up[] = { { 0, 1 }, { 0, -1 }, { 1, 0 } };
        plumb_world_desc desc = { .y_axis = k == 1 ? PLUMB_Y_DOWN : PLUMB_Y_UP };
        desc.gravity = k == 2 ? V(-9.81, 0) : V(0, 0);
        plumb_world *world = NULL;
        plumb_world_create(&desc, &world);
        plumb_rot q = plumb_rot_from_direction(k == 1 ? V(-1, 0) : right[k]);
        plumb_body floor = add_box(world, PLUMB_STATIC, plumb_vec2_neg(up[k]), V(100, 1));
        plumb_body_teleport(world, floor, plumb_vec2_neg(up[k]), plumb_rot_angle(q));
        plumb_body hero = add_hero(world, 0, 0, NULL);
        plumb_body_teleport(world, hero, plumb_vec2_scale(R(STANDS + SKIN), up[k]),
                            plumb_rot_angle(q));
        plumb_character_walk(world, hero, 3);
        run(world, 60, 1);
        plumb_vec2 p = plumb_body_position(world, hero);
        assert_near(plumb_vec2_dot(p, right[k]), 3, ROUNDED(1e-4));
        assert_near(plumb_vec2_dot(p, up[k]), STANDS + SKIN, ROUNDED(1e-4));
        assert_true(plumb_character_jump(world, hero, 5));
        run(world, 60, 0.5);
        p = plumb_body_position(world, hero);
        assert_near(plumb_vec2_dot(p, right[k]), 4.5, ROUNDED(1e-4));
        assert_near(plumb_vec2_dot(p, up[k]) - R(STANDS + SKIN), 2.5 - 9.81 / 8, ROUNDED(1e-4));
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
    assert_near(feet_of(world, hero), 0, ROUNDED(1e-4));
    assert_near(x_of(world, other), 2.5 - RADIUS - SKIN, ROUNDED(1e-4));
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
    assert_near(y_of(world, crate), 2 * STANDS + SKIN + 0.3, 0.01);
    assert_near(feet_of(world, hero), 0, ROUNDED(1e-5));
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
    assert_near(feet_of(world, hero), 0, ROUNDED(1e-4));
    plumb_shape shape;
    plumb_body_shapes(world, hero, &shape, 1);
    plumb_shape_destroy(world, shape); // nothing to stand with: it stays where it is
    run(world, 60, 1);
    assert_near(feet_of(world, hero), 0, ROUNDED(1e-4));
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
    assert_near(feet_of(world, slow), 6 * 0.5 - 9.81 / 8, ROUNDED(1e-4));
    assert_near(x_of(world, slow) - x, 1, ROUNDED(1e-4));
    assert_near(x_of(world, rider), 20.5, ROUNDED(1e-3));
    assert_near(feet_of(world, rider), 1.5, ROUNDED(1e-3));
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
    assert_near(x_of(world, hero), 3, ROUNDED(0.1));
    plumb_body_set_type(world, hero, PLUMB_STATIC);
    run(world, 60, 0.5);
    assert_near(x_of(world, hero), 3, ROUNDED(0.1));
    plumb_body_set_type(world, hero, PLUMB_KINEMATIC);
    plumb_body_set_enabled(world, hero, false);
    run(world, 60, 0.5);
    assert_near(x_of(world, hero), 3, ROUNDED(0.1));
    plumb_body_set_enabled(world, hero, true);
    run(world, 60, 1);
    assert_near(x_of(world, hero), 5, ROUNDED(0.1));
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
        assert_near(feet_of(world, hero), 0, ROUNDED(1e-3));
        plumb_world_destroy(world);
    }
    assert_near(end[0], end[1], ROUNDED(0.02));
    assert_true(end[0] > 11);
}

// Hills with loose boxes and discs of 1 to 500 kg/m^2, over which somebody of 70 kg walks and jumps. The fastest that the walker and
// that a thing became [m/s].
static void tread(uint32_t seed, plumb_body_type type, double density, double *walker,
                  double *thing)
{
    plumb_world *world = make_world();
    enum { POINTS = 30, MOST = 5 };
    plumb_vec2 hills[POINTS];
    double x = 40, y = 0;
    for (int i = 0; i < POINTS; ++i) { // from the right: solid below
        hills[i] = V(x, y);
        x -= sim_uniform(&seed, 1, 2);
        y += sim_uniform(&seed, -0.2, 0.2);
    }
    add_chain(world, hills, POINTS);
    const double start = (double)hills[POINTS - 3].x;
    const plumb_vec2 from = V(start, (double)hills[POINTS - 3].y + 0.5 + STANDS);
    const plumb_body hero = add_hero_of(world, type, from, NULL);
    plumb_character_walk(world, hero, R(sim_uniform(&seed, 1, 4)));
    plumb_body things[MOST];
    for (int i = 0; i < MOST; ++i) {
        const double r = sim_uniform(&seed, 0.05, 0.35), flat = sim_uniform(&seed, 0.5, 1);
        things[i] = add_body(world, PLUMB_DYNAMIC, V(start + 2 + 1.2 * i, 4));
        const plumb_shape_desc disc = { .kind = PLUMB_CIRCLE,
                                        .radius = R(r),
                                        .density = R(density) };
        const plumb_shape_desc box = { .kind = PLUMB_BOX,
                                       .half = V(r, r * flat),
                                       .density = R(density) };
        plumb_shape_create(world, things[i], i % 3 == 0 ? &disc : &box);
    }
    *walker = *thing = 0;
    for (int step = 0; step < 400; ++step) {
        if (step % 70 == 69) {
            plumb_character_jump(world, hero, 4);
        }
        plumb_world_step(world, R(1 / 60.0));
        const plumb_vec2 v = state_of(world, hero).velocity;
        *walker = fmax(*walker, hypot((double)v.x, (double)v.y));
        for (int i = 0; i < MOST; ++i) {
            const plumb_vec2 u = plumb_body_velocity(world, things[i]);
            *thing = fmax(*thing, hypot((double)u.x, (double)u.y));
        }
    }
    plumb_world_destroy(world);
}

// What acts for a whole step on what is far lighter threw it, and whom it carried: of 149 walkers over things of 1 kg/m^2
// 127 flew at up to 7e8 m/s, and 135 times a thing did.
static void light_things_bear_who_treads_on_them(void **state)
{
    (void)state;
    const double densities[] = { 1, 10, 100, 500 };
    const plumb_body_type types[] = { PLUMB_KINEMATIC, PLUMB_DYNAMIC };
    for (int t = 0; t < 2; ++t) {
        int walkers = 0, all = 0;
        double most = 0;
        for (uint32_t seed = 1; seed <= 25; ++seed) {
            for (int d = 0; d < 4; ++d, ++all) {
                double walker, thing;
                tread(seed, types[t], densities[d], &walker, &thing);
                walkers += walker > 15;
                most = fmax(most, thing);
            }
        }
        print_message("%d of %d %s walkers faster than 15 m/s; things up to %.1f m/s\n", walkers,
                      all, t == 0 ? "kinematic" : "dynamic", most);
        assert_true(walkers * 50 <= all);
        assert_true(most < 40);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(ceilings),
        cmocka_unit_test(which_way_is_up),
        cmocka_unit_test(comes_out_of_what_it_was_put_in),
        cmocka_unit_test(is_a_body_to_others),
        cmocka_unit_test(ground_may_go),
        cmocka_unit_test(sleeping_ground),
        cmocka_unit_test(own_time),
        cmocka_unit_test(other_types),
        cmocka_unit_test(far_from_the_origin),
        cmocka_unit_test(light_things_bear_who_treads_on_them),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
