// test_api_type.c - whether and how bodies take part: type and enabling; what each refuses and in
// which words.
#include "world_fixture.h"

#define NONE ((plumb_body)PLUMB_NULL_INIT)
#define STEP R(1.0 / 60)

static void steps(fixture *f, int count)
{
    for (int i = 0; i < count; ++i) {
        assert_int_equal(plumb_world_step(f->world, STEP), PLUMB_OK);
    }
}

static plumb_body crate(fixture *f, plumb_real x, plumb_real y)
{
    plumb_body b = plumb_body_create(f->world, &(plumb_body_desc){ .position = { x, y } });
    plumb_shape_create(f->world, b,
                       &(plumb_shape_desc){ .kind = PLUMB_BOX, .half = { R(0.5), R(0.5) } });
    return b;
}

//---- type ----------------------------------------------------------------------------------------

static void type_changes_and_partitions_stay_whole(void **state)
{
    fixture *f = *state;
    plumb_world *w = f->world;
    plumb_body b[12];
    for (int i = 0; i < 12; ++i) {
        b[i] = crate(f, R(3 * i - 40), 20);
    }
    for (int i = 0; i < 60; ++i) {
        plumb_body_type type = (plumb_body_type)((i * 7 + i / 5) % 3);
        plumb_body which = b[(i * 5) % 12];
        assert_int_equal(plumb_body_set_type(w, which, type), PLUMB_OK);
        assert_int_equal(plumb_body_set_enabled(w, b[(i * 7) % 12], i % 4 != 0), PLUMB_OK);
        assert_int_equal(plumb_body_get_type(w, which), type);
        plumb_body_span s = plumb_world_bodies(w);
        int seen[4] = { 0 };
        for (int row = 0; row < s.count; ++row) {
            plumb_body_type is = plumb_body_get_type(w, s.body[row]);
            int part = !plumb_body_is_enabled(w, s.body[row]) ? 3 : (int)is;
            ++seen[part];
            int first[] = { 0, s.dynamic_count, s.dynamic_count + s.kinematic_count,
                            s.count - s.disabled_count };
            int size[] = { s.dynamic_count, s.kinematic_count, s.static_count, s.disabled_count };
            assert_true(row >= first[part] && row < first[part] + size[part]);
        }
        assert_int_equal(seen[0], s.dynamic_count);
        assert_int_equal(seen[3], s.disabled_count);
        steps(f, 1);
    }
    plumb_stats stats = plumb_world_stats(w);
    plumb_body_span s = plumb_world_bodies(w);
    assert_int_equal(stats.static_count, s.static_count);
    assert_int_equal(stats.disabled_count, s.disabled_count);
    assert_int_equal(f->errors, 0);
}

static void a_type_brings_its_mass_and_centre(void **state)
{
    fixture *f = *state;
    plumb_world *w = f->world;
    plumb_body b = plumb_body_create(
        w,
        &(plumb_body_desc){ .position = { 0, 20 }, .velocity = { 1, 0 }, .angular_velocity = 2 });
    plumb_shape_create(
        w, b, &(plumb_shape_desc){ .kind = PLUMB_CIRCLE, .radius = 1, .center = { 3, 0 } });
    plumb_vec2 at_origin = plumb_body_velocity_at(w, b, plumb_v2(0, 20));
    plumb_real mass = plumb_body_mass(w, b), inertia = plumb_body_inertia(w, b);
    plumb_body_apply_force_center(w, b, plumb_v2(5, 5));

    assert_int_equal(plumb_body_set_type(w, b, PLUMB_KINEMATIC), PLUMB_OK);
    assert_near(plumb_body_mass(w, b), 0, 0);
    assert_near(plumb_body_inertia(w, b), 0, 0);
    assert_vec_near(plumb_body_force(w, b), 0, 0, 0);
    assert_vec_near(plumb_body_center(w, b), 0, 20, 0); // it turns about its origin now
    assert_vec_near(plumb_body_velocity(w, b), at_origin.x, at_origin.y, ROUNDED(1e-5));
    assert_near(plumb_body_angular_velocity(w, b), 2, 0);

    assert_int_equal(plumb_body_set_type(w, b, PLUMB_STATIC), PLUMB_OK);
    assert_vec_near(plumb_body_velocity(w, b), 0, 0, 0);
    assert_near(plumb_body_angular_velocity(w, b), 0, 0);
    steps(f, 5);
    assert_vec_near(plumb_body_position(w, b), 0, 20, 0);

    assert_int_equal(plumb_body_set_type(w, b, PLUMB_DYNAMIC), PLUMB_OK);
    assert_near(plumb_body_mass(w, b), mass, 0);
    assert_near(plumb_body_inertia(w, b), inertia, 0);
    assert_vec_near(plumb_body_center(w, b), 3, 20, ROUNDED(1e-6));
    steps(f, 5);
    assert_true(plumb_body_position(w, b).y < R(19.99));
    assert_int_equal(plumb_body_set_type(w, b, PLUMB_DYNAMIC), PLUMB_OK); // nothing to do
}

// A box on the ground: the ground becomes dynamic and falls away, is static again far below.
static void contacts_follow_the_type(void **state)
{
    fixture *f = *state;
    plumb_world *w = f->world;
    plumb_body_teleport(w, f->dynamic, plumb_v2(0, 2), 0);
    steps(f, 30);
    assert_int_equal(plumb_body_contacts(w, f->dynamic, NULL, 0), 1);
    plumb_body_set_type(w, f->fixed, PLUMB_DYNAMIC);
    steps(f, 30);
    assert_true(plumb_body_position(w, f->fixed).y < -1);
    assert_true(plumb_body_position(w, f->dynamic).y < 1);
    plumb_body_set_type(w, f->fixed, PLUMB_STATIC);
    steps(f, 120);
    assert_near(plumb_body_position(w, f->dynamic).y, plumb_body_position(w, f->fixed).y + 2, 0.02);
    plumb_body_set_type(w, f->fixed, PLUMB_KINEMATIC);
    plumb_body_set_velocity(w, f->fixed, plumb_v2(0, 1));
    plumb_real before = plumb_body_position(w, f->dynamic).y;
    steps(f, 60);
    assert_near(plumb_body_position(w, f->dynamic).y, before + 1, ROUNDED(0.03));
}

static void joints_follow_the_type(void **state)
{
    fixture *f = *state;
    plumb_world *w = f->world;
    plumb_joint rod = plumb_joint_create(w, &(plumb_joint_desc){ .kind = PLUMB_DISTANCE,
                                                                 .body_a = f->fixed,
                                                                 .body_b = f->dynamic,
                                                                 .anchor_b = { 0, 5 } });
    plumb_body_set_type(w, f->dynamic, PLUMB_STATIC);
    plumb_body_set_type(w, f->fixed, PLUMB_DYNAMIC); // hangs below it now
    plumb_body_set_position(w, f->dynamic, plumb_v2(0, 5));
    steps(f, 240);
    assert_near(plumb_joint_value(w, rod), 5, 0.01);
    assert_near(plumb_body_position(w, f->fixed).y, 0, 0.01);
    assert_true(plumb_joint_valid(w, rod));
}

static void type_is_refused(void **state)
{
    fixture *f = *state;
    plumb_world *w = f->world;
    REFUSED(E_HANDLE, "plumb_body_set_type: body is null; it must be a live body",
            plumb_body_set_type(w, NONE, PLUMB_STATIC));
    REFUSED(E_RANGE, "plumb_body_set_type: type is 3; it must be a plumb_body_type",
            plumb_body_set_type(w, f->dynamic, (plumb_body_type)3));
    plumb_body heavy = plumb_body_create(w, &(plumb_body_desc){ .type = PLUMB_STATIC });
    plumb_shape_create(
        w, heavy, &(plumb_shape_desc){ .kind = PLUMB_CIRCLE, .radius = 1, .density = R(1e37) });
    REFUSED(E_RANGE,
            sizeof(plumb_real) == 4
                ? "plumb_body_set_type: mass is 3.14159e+37; mass and inertia of the body must be "
                  "1e-36 to 1e+36"
                : "plumb_body_set_type: mass is 3.14159e+37; mass and inertia of the body must be "
                  "1e-36 to 1e+36",
            plumb_body_set_type(w, heavy, PLUMB_DYNAMIC));
    assert_int_equal(plumb_body_set_type(NULL, NONE, PLUMB_STATIC), PLUMB_E_NULL);
}

static void change_type(const plumb_system_call *call)
{
    fixture *f = call->context;
    plumb_body_set_type(f->world, f->dynamic, PLUMB_STATIC);
    assert_int_equal(plumb_world_error(f->world).code, PLUMB_E_LOCKED);
    assert_string_equal(
        plumb_world_error(f->world).message,
        "plumb_body_set_type: the world is stepping (system 's'); call it between steps");
    plumb_body_set_enabled(f->world, f->dynamic, false);
    assert_string_equal(
        plumb_world_error(f->world).message,
        "plumb_body_set_enabled: the world is stepping (system 's'); call it between steps");
    plumb_body_set_position(f->world, f->dynamic, plumb_v2(0, 0));
    plumb_body_set_angle(f->world, f->dynamic, 0);
    assert_int_equal(f->errors, 4);
}

static void structure_is_locked_in_a_step(void **state)
{
    fixture *f = *state;
    plumb_system_create(f->world,
                        &(plumb_system_desc){ .name = "s", .run = change_type, .context = f });
    steps(f, 1);
    assert_int_equal(plumb_body_get_type(f->world, f->dynamic), PLUMB_DYNAMIC);
}

//---- enabling ------------------------------------------------------------------------------------

static void a_disabled_body_is_out(void **state)
{
    fixture *f = *state;
    plumb_world *w = f->world;
    plumb_body_set_velocity(w, f->dynamic, plumb_v2(1, 2));
    assert_true(plumb_body_is_enabled(w, f->dynamic));
    assert_int_equal(plumb_body_set_enabled(w, f->dynamic, false), PLUMB_OK);
    assert_int_equal(plumb_body_set_enabled(w, f->dynamic, false), PLUMB_OK);
    assert_false(plumb_body_is_enabled(w, f->dynamic));
    steps(f, 10);
    assert_vec_near(plumb_body_position(w, f->dynamic), 0, 5, 0);
    assert_vec_near(plumb_body_velocity(w, f->dynamic), 1, 2, 0);
    plumb_ray_hit hit;
    assert_false(plumb_world_ray(w, plumb_v2(-5, 5), plumb_v2(5, 5), NULL, &hit));
    assert_int_equal(plumb_world_overlap_point(w, plumb_v2(0, 5), NULL, NULL, 0), 0);
    assert_int_equal(plumb_body_shapes(w, f->dynamic, NULL, 0), 1);
    // What falls there falls through.
    plumb_body b = crate(f, 0, 8);
    steps(f, 60);
    assert_true(plumb_body_position(w, b).y < 5);
    // It can be changed meanwhile.
    plumb_shape_create(w, f->dynamic, &(plumb_shape_desc){ .kind = PLUMB_CIRCLE, .radius = 2 });
    plumb_body_teleport(w, f->dynamic, plumb_v2(50, 5), 1);
    assert_int_equal(plumb_body_set_enabled(w, f->dynamic, true), PLUMB_OK);
    assert_true(plumb_world_ray(w, plumb_v2(40, 5), plumb_v2(60, 5), NULL, &hit));
    assert_near(hit.point.x, 48, ROUNDED(1e-4));
    steps(f, 10);
    assert_true(plumb_body_position(w, f->dynamic).x > R(50.1));
    assert_int_equal(f->errors, 0);
}

static void all_types_can_be_disabled(void **state)
{
    fixture *f = *state;
    plumb_world *w = f->world;
    plumb_body_teleport(w, f->dynamic, plumb_v2(0, 2), 0);
    steps(f, 30);
    plumb_body_set_enabled(w, f->fixed, false);
    plumb_body_set_velocity(w, f->kinematic, plumb_v2(3, 0));
    plumb_body_set_enabled(w, f->kinematic, false);
    steps(f, 30);
    assert_true(plumb_body_position(w, f->dynamic).y < 1);
    assert_vec_near(plumb_body_position(w, f->kinematic), 10, 0, 0);
    plumb_body_teleport(w, f->dynamic, plumb_v2(0, 3), 0);
    plumb_body_set_velocity(w, f->dynamic, plumb_v2(0, 0));
    plumb_body_set_enabled(w, f->fixed, true);
    plumb_body_set_enabled(w, f->kinematic, true);
    steps(f, 60);
    assert_near(plumb_body_position(w, f->dynamic).y, 2, 0.02);
    assert_near(plumb_body_position(w, f->kinematic).x, 13, ROUNDED(1e-3));
    // A disabled body's type can change, and it can be destroyed.
    plumb_body_set_enabled(w, f->fixed, false);
    assert_int_equal(plumb_body_set_type(w, f->fixed, PLUMB_DYNAMIC), PLUMB_OK);
    steps(f, 10);
    assert_vec_near(plumb_body_position(w, f->fixed), 0, 0, 0);
    assert_int_equal(plumb_world_stats(w).disabled_count, 1);
    plumb_body_destroy(w, f->fixed);
    assert_int_equal(plumb_world_stats(w).disabled_count, 0);
    plumb_body off =
        plumb_body_create(w, &(plumb_body_desc){ .disabled = true, .position = { 0, 9 } });
    plumb_shape_create(w, off, &(plumb_shape_desc){ .kind = PLUMB_CIRCLE, .radius = 1 });
    steps(f, 10);
    assert_vec_near(plumb_body_position(w, off), 0, 9, 0);
    assert_false(plumb_body_is_enabled(w, f->stale));
}

static void disabling_ends_touches_and_rests_joints(void **state)
{
    fixture *f = *state;
    plumb_world *w = f->world;
    plumb_body_teleport(w, f->dynamic, plumb_v2(0, 2), 0);
    plumb_joint pin = plumb_joint_create(
        w, &(plumb_joint_desc){ .body_a = f->kinematic, .body_b = f->dynamic, .anchor = { 0, 2 } });
    steps(f, 30);
    int count = 0;
    plumb_body_set_enabled(w, f->fixed, false);
    assert_int_equal(plumb_body_contacts(w, f->dynamic, NULL, 0), 0);
    steps(f, 1);
    plumb_world_end_events(w, &count);
    assert_int_equal(count, 1);
    steps(f, 60);
    assert_true(fabs((double)plumb_joint_force(w, pin).y) > 20); // it hangs on its pin
    plumb_body_set_enabled(w, f->kinematic, false);
    steps(f, 30);
    assert_vec_near(plumb_joint_force(w, pin), 0, 0, 0);
    assert_true(plumb_joint_is_enabled(w, pin));
    assert_true(plumb_body_position(w, f->dynamic).y < 1);
}

static void enabling_is_refused(void **state)
{
    fixture *f = *state;
    plumb_world *w = f->world;
    REFUSED(E_HANDLE, "plumb_body_set_enabled: body is stale (0:1); it must be a live body",
            plumb_body_set_enabled(w, f->stale, true));
    plumb_body_set_enabled(w, f->dynamic, false);
    REFUSED(E_STATE, "plumb_body_apply_force_center: body is disabled; it must be enabled",
            plumb_body_apply_force_center(w, f->dynamic, plumb_v2(1, 1)));
    REFUSED(E_STATE, "plumb_body_apply_impulse: body is disabled; it must be enabled",
            plumb_body_apply_impulse(w, f->dynamic, plumb_v2(1, 1), plumb_v2(0, 0)));
    REFUSED(E_STATE, "plumb_body_apply_torque: body is disabled; it must be enabled",
            plumb_body_apply_torque(w, f->dynamic, 1));
}

//---- what slept ----------------------------------------------------------------------------------

enum { SLEEPERS = 8 };

// A row of sleeping balls that a step has filed, a static sensor over each.
static void lay_to_rest(fixture *f, plumb_body *ball, plumb_shape *sensor)
{
    for (int i = 0; i < SLEEPERS; ++i) {
        const plumb_vec2 at = { R(3 * i - 40), 30 };
        plumb_body eye =
            plumb_body_create(f->world, &(plumb_body_desc){ .type = PLUMB_STATIC, .position = at });
        ball[i] = plumb_body_create(f->world, &(plumb_body_desc){ .position = at, .asleep = true });
        const plumb_shape_desc round = { .kind = PLUMB_CIRCLE, .radius = R(0.5) };
        plumb_shape_create(f->world, ball[i], &round);
        plumb_shape_desc sees = round;
        sees.sensor = true;
        sensor[i] = plumb_shape_create(f->world, eye, &sees);
    }
    steps(f, 2);
    for (int i = 0; i < SLEEPERS; ++i) {
        assert_int_equal(plumb_shape_overlaps(f->world, sensor[i], NULL, 0), 1);
    }
}

static int met(plumb_world *w, int i, const plumb_query_filter *filter)
{
    plumb_ray_hit hits[4];
    const plumb_vec2 low = { R(3 * i - 40), 28 }, high = { R(3 * i - 40), 32 };
    return plumb_world_ray_all(w, low, high, filter, hits, 4);
}

static void what_slept_is_what_it_became(void **state)
{
    fixture *f = *state;
    plumb_world *w = f->world;
    plumb_body ball[SLEEPERS];
    plumb_shape sensor[SLEEPERS];
    lay_to_rest(f, ball, sensor);
    assert_int_equal(plumb_body_set_type(w, ball[0], PLUMB_STATIC), PLUMB_OK);
    assert_int_equal(plumb_body_set_enabled(w, ball[1], false), PLUMB_OK);
    for (int i = 0; i < 2; ++i) { // before and after a step
        const plumb_query_filter moving = { .ignore_static = true },
                                 still = { .ignore_dynamic = true };
        assert_int_equal(met(w, 0, NULL), 1);
        assert_int_equal(met(w, 0, &moving), 0);
        assert_int_equal(met(w, 0, &still), 1);
        assert_int_equal(met(w, 1, NULL), 0);
        assert_int_equal(met(w, 2, &moving), 1);
        assert_int_equal(met(w, 2, &still), 0);
        steps(f, 1);
    }
    assert_int_equal(plumb_shape_overlaps(w, sensor[0], NULL, 0), 0);
    assert_int_equal(plumb_shape_overlaps(w, sensor[1], NULL, 0), 0);
    assert_int_equal(plumb_shape_overlaps(w, sensor[2], NULL, 0), 1);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        API_TEST(what_slept_is_what_it_became),
        API_TEST(type_changes_and_partitions_stay_whole),
        API_TEST(a_type_brings_its_mass_and_centre),
        API_TEST(contacts_follow_the_type),
        API_TEST(joints_follow_the_type),
        API_TEST(type_is_refused),
        API_TEST(structure_is_locked_in_a_step),
        API_TEST(a_disabled_body_is_out),
        API_TEST(all_types_can_be_disabled),
        API_TEST(disabling_ends_touches_and_rests_joints),
        API_TEST(enabling_is_refused),
    };
    return cmocka_run_group_tests_name("type", tests, NULL, NULL);
}
