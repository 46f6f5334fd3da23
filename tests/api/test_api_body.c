// test_api_body.c - bodies: what a descriptor sets, place and frames, forces and impulses, mass and
// centre.
#include "world_fixture.h"

#define PI 3.14159265358979323846

//---- making and asking ---------------------------------------------------------------------------

static void a_zero_descriptor_is_a_dynamic_body_at_the_origin(void **state)
{
    fixture *f = *state;
    plumb_world *w = f->world;
    plumb_body b = plumb_body_create(w, &(plumb_body_desc){ 0 });
    assert_true(plumb_body_valid(w, b));
    assert_int_equal(plumb_body_get_type(w, b), PLUMB_DYNAMIC);
    assert_vec_near(plumb_body_position(w, b), 0, 0, 0);
    assert_near(plumb_body_angle(w, b), 0, 0);
    assert_near(plumb_body_mass(w, b), 1, 0);
    assert_near(plumb_body_inertia(w, b), 0, 0);
    assert_near(plumb_body_gravity_scale(w, b), 1, 0);
    assert_null(plumb_body_user_data(w, b));
    plumb_aabb box = plumb_body_aabb(w, b);
    assert_true(box.min.x > box.max.x);
    assert_int_equal(plumb_body_shapes(w, b, NULL, 0), 0);
}

static void a_descriptor_is_read_back(void **state)
{
    fixture *f = *state;
    plumb_world *w = f->world;
    int mine;
    plumb_body b = plumb_body_create(w, &(plumb_body_desc){ .position = { 2, -3 },
                                                            .angle = R(PI / 2),
                                                            .velocity = { 4, 5 },
                                                            .angular_velocity = 6,
                                                            .mass = 7,
                                                            .inertia = 8,
                                                            .gravity_scale = -2,
                                                            .user_data = &mine });
    assert_vec_near(plumb_body_position(w, b), 2, -3, 0);
    assert_vec_near(plumb_body_center(w, b), 2, -3, 0);
    assert_near(plumb_body_angle(w, b), PI / 2, ROUNDED(1e-6));
    assert_vec_near(plumb_body_velocity(w, b), 4, 5, 0);
    assert_near(plumb_body_angular_velocity(w, b), 6, 0);
    assert_near(plumb_body_mass(w, b), 7, 0);
    assert_near(plumb_body_inertia(w, b), 8, 0);
    assert_near(plumb_body_gravity_scale(w, b), -2, 0);
    assert_ptr_equal(plumb_body_user_data(w, b), &mine);
    assert_vec_near(plumb_body_world_point(w, b, plumb_v2(1, 0)), 2, -2, ROUNDED(1e-6));
    assert_vec_near(plumb_body_local_point(w, b, plumb_v2(2, -2)), 1, 0, ROUNDED(1e-6));
    assert_vec_near(plumb_body_world_vector(w, b, plumb_v2(1, 0)), 0, 1, ROUNDED(1e-6));
    assert_vec_near(plumb_body_local_vector(w, b, plumb_v2(0, 1)), 1, 0, ROUNDED(1e-6));
    // v + w x r, r = (0, 1) from the centre.
    assert_vec_near(plumb_body_velocity_at(w, b, plumb_v2(2, -2)), 4 - 6, 5, ROUNDED(1e-6));
    plumb_transform t = plumb_body_transform(w, b);
    assert_vec_near(t.p, 2, -3, 0);
    assert_near(t.q.s, 1, ROUNDED(1e-6));
    assert_int_equal(plumb_body_set_user_data(w, b, NULL), PLUMB_OK);
    assert_null(plumb_body_user_data(w, b));
    assert_int_equal(plumb_body_set_gravity_scale(w, b, 0), PLUMB_OK);
    assert_near(plumb_body_gravity_scale(w, b), 0, 0);
    b = plumb_body_create(w, &(plumb_body_desc){ .no_gravity = true });
    assert_near(plumb_body_gravity_scale(w, b), 0, 0);
}

static void bad_handles_are_answered_with_zeros(void **state)
{
    fixture *f = *state;
    plumb_world *w = f->world;
    const plumb_body handles[] = {
        PLUMB_NULL_INIT, f->stale, { f->box.entity }, { f->wood.entity }
    };
    for (int i = 0; i < 4; ++i) {
        plumb_body b = handles[i];
        assert_false(plumb_body_valid(w, b));
        assert_vec_near(plumb_body_position(w, b), 0, 0, 0);
        assert_vec_near(plumb_body_center(w, b), 0, 0, 0);
        assert_vec_near(plumb_body_local_center(w, b), 0, 0, 0);
        assert_vec_near(plumb_body_velocity(w, b), 0, 0, 0);
        assert_vec_near(plumb_body_velocity_at(w, b, plumb_v2(1, 1)), 0, 0, 0);
        assert_vec_near(plumb_body_world_point(w, b, plumb_v2(1, 1)), 0, 0, 0);
        assert_vec_near(plumb_body_local_point(w, b, plumb_v2(1, 1)), 0, 0, 0);
        assert_vec_near(plumb_body_world_vector(w, b, plumb_v2(1, 1)), 0, 0, 0);
        assert_vec_near(plumb_body_local_vector(w, b, plumb_v2(1, 1)), 0, 0, 0);
        assert_true(plumb_body_angle(w, b) == 0 && plumb_body_angular_velocity(w, b) == 0);
        assert_true(plumb_body_mass(w, b) == 0 && plumb_body_inertia(w, b) == 0);
        assert_true(plumb_body_gravity_scale(w, b) == 0);
        assert_null(plumb_body_user_data(w, b));
        assert_int_equal(plumb_body_shapes(w, b, NULL, 0), 0);
        assert_true(plumb_aabb_is_empty(plumb_body_aabb(w, b)));
    }
}

static void destruction_takes_the_shapes_along(void **state)
{
    fixture *f = *state;
    assert_int_equal(plumb_body_destroy(f->world, f->dynamic), PLUMB_OK);
    assert_false(plumb_body_valid(f->world, f->dynamic));
    assert_false(plumb_shape_valid(f->world, f->box));
    assert_int_equal(plumb_world_stats(f->world).shape_count, 2);
    assert_true(plumb_body_valid(f->world, f->fixed));
    assert_vec_near(plumb_body_position(f->world, f->kinematic), 10, 0, 0);
}

static void teleport_moves_at_once_and_keeps_velocity(void **state)
{
    fixture *f = *state;
    plumb_world *w = f->world;
    plumb_body_set_velocity(w, f->dynamic, plumb_v2(1, 2));
    plumb_body_set_angular_velocity(w, f->dynamic, 3);
    assert_int_equal(plumb_body_teleport(w, f->dynamic, plumb_v2(-4, 8), R(PI / 2)), PLUMB_OK);
    assert_vec_near(plumb_body_position(w, f->dynamic), -4, 8, 0);
    assert_near(plumb_body_angle(w, f->dynamic), PI / 2, ROUNDED(1e-6));
    assert_vec_near(plumb_body_velocity(w, f->dynamic), 1, 2, 0);
    assert_near(plumb_body_angular_velocity(w, f->dynamic), 3, 0);
    plumb_aabb box = plumb_body_aabb(w, f->dynamic);
    assert_vec_near(box.min, -5, 7, ROUNDED(1e-5));
    assert_vec_near(box.max, -3, 9, ROUNDED(1e-5));
    assert_int_equal(plumb_body_teleport(w, f->fixed, plumb_v2(3, 0), 0), PLUMB_OK);
    assert_vec_near(plumb_body_position(w, f->fixed), 3, 0, 0);
}

static void a_kinematic_body_moves_by_its_velocity_alone(void **state)
{
    fixture *f = *state;
    plumb_world *w = f->world;
    assert_int_equal(plumb_body_set_velocity(w, f->kinematic, plumb_v2(0, 2)), PLUMB_OK);
    assert_int_equal(plumb_body_set_angular_velocity(w, f->kinematic, 1), PLUMB_OK);
    for (int i = 0; i < 8; ++i) {
        plumb_world_step(w, R(0.125));
    }
    assert_vec_near(plumb_body_position(w, f->kinematic), 10, 2, ROUNDED(1e-5));
    assert_near(plumb_body_angle(w, f->kinematic), 1, ROUNDED(1e-5));
    assert_near(plumb_body_mass(w, f->kinematic), 0, 0);
    assert_near(plumb_body_inertia(w, f->kinematic), 0, 0);
}

//---- pushing -------------------------------------------------------------------------------------

static void forces_last_one_step(void **state)
{
    fixture *f = *state;
    plumb_world *w = f->world;
    plumb_world_set_gravity(w, plumb_v2(0, 0));
    plumb_real mass = plumb_body_mass(w, f->dynamic);
    plumb_real inertia = plumb_body_inertia(w, f->dynamic);
    assert_near(mass, 4, ROUNDED(1e-5));
    assert_near(inertia, 4 * (4 + 4) / 12.0, ROUNDED(1e-5));
    assert_int_equal(plumb_body_apply_force_center(w, f->dynamic, plumb_v2(8, 0)), PLUMB_OK);
    // At (1, 5), one to the right of the centre: torque 1 x 4.
    assert_int_equal(plumb_body_apply_force(w, f->dynamic, plumb_v2(0, 4), plumb_v2(1, 5)),
                     PLUMB_OK);
    assert_int_equal(plumb_body_apply_torque(w, f->dynamic, 2), PLUMB_OK);
    plumb_world_step(w, R(0.5));
    assert_vec_near(plumb_body_velocity(w, f->dynamic), 1, 0.5, ROUNDED(1e-5));
    assert_near(plumb_body_angular_velocity(w, f->dynamic), 6 / inertia * R(0.5), ROUNDED(1e-5));
    plumb_world_step(w, R(0.5));
    assert_vec_near(plumb_body_velocity(w, f->dynamic), 1, 0.5, ROUNDED(1e-5));
}

static void impulses_act_at_once(void **state)
{
    fixture *f = *state;
    plumb_world *w = f->world;
    plumb_real inertia = plumb_body_inertia(w, f->dynamic);
    assert_int_equal(plumb_body_apply_impulse_center(w, f->dynamic, plumb_v2(4, 0)), PLUMB_OK);
    assert_vec_near(plumb_body_velocity(w, f->dynamic), 1, 0, ROUNDED(1e-6));
    assert_int_equal(plumb_body_apply_impulse(w, f->dynamic, plumb_v2(4, 0), plumb_v2(0, 6)),
                     PLUMB_OK);
    assert_vec_near(plumb_body_velocity(w, f->dynamic), 2, 0, ROUNDED(1e-6));
    assert_near(plumb_body_angular_velocity(w, f->dynamic), -4 / inertia, ROUNDED(1e-6));
    assert_int_equal(plumb_body_apply_angular_impulse(w, f->dynamic, 4), PLUMB_OK);
    assert_near(plumb_body_angular_velocity(w, f->dynamic), 0, ROUNDED(1e-6));
}

//---- mass ----------------------------------------------------------------------------------------

static void mass_and_centre_follow_the_shapes(void **state)
{
    fixture *f = *state;
    plumb_world *w = f->world;
    plumb_body b = plumb_body_create(w, &(plumb_body_desc){ .position = { 10, 10 },
                                                            .angle = R(PI / 2),
                                                            .velocity = { 1, 0 },
                                                            .angular_velocity = 2 });
    plumb_shape_desc box = { .kind = PLUMB_BOX, .half = { R(0.5), R(0.5) }, .density = 3 };
    box.center = plumb_v2(1, 0);
    plumb_shape right = plumb_shape_create(w, b, &box);
    assert_near(plumb_body_mass(w, b), 3, ROUNDED(1e-6));
    assert_near(plumb_body_inertia(w, b), 3 * 2 / 12.0, ROUNDED(1e-6));
    assert_vec_near(plumb_body_local_center(w, b), 1, 0, ROUNDED(1e-6));
    assert_vec_near(plumb_body_position(w, b), 10, 10, 0); // the origin stays
    assert_vec_near(plumb_body_center(w, b), 10, 11, ROUNDED(1e-5));
    // The centre went (0, 1) off: v' = v + w x d.
    assert_vec_near(plumb_body_velocity(w, b), 1 - 2, 0, ROUNDED(1e-5));
    box.center = plumb_v2(-1, 0);
    box.density = 0; // the default material's: 1
    plumb_shape left = plumb_shape_create(w, b, &box);
    assert_near(plumb_body_mass(w, b), 4, ROUNDED(1e-6));
    assert_vec_near(plumb_body_local_center(w, b), 0.5, 0, ROUNDED(1e-6));
    assert_near(plumb_body_inertia(w, b), 0.5 + 3 * 0.25 + 1.0 / 6 + 1 * 2.25, ROUNDED(1e-5));
    plumb_shape_destroy(w, right);
    assert_near(plumb_body_mass(w, b), 1, ROUNDED(1e-6));
    assert_vec_near(plumb_body_local_center(w, b), -1, 0, ROUNDED(1e-6));
    plumb_shape_destroy(w, left);
    assert_near(plumb_body_mass(w, b), 1, 0); // no shapes: 1 kg and no inertia
    assert_near(plumb_body_inertia(w, b), 0, 0);
    assert_vec_near(plumb_body_local_center(w, b), 0, 0, 0);
    assert_vec_near(plumb_body_velocity(w, b), 1, 0, 1e-5); // back where it was
}

static void a_given_mass_scales_the_inertia(void **state)
{
    fixture *f = *state;
    plumb_world *w = f->world;
    plumb_real inertia = plumb_body_inertia(w, f->dynamic);
    assert_int_equal(plumb_body_set_mass(w, f->dynamic, 40), PLUMB_OK);
    assert_near(plumb_body_mass(w, f->dynamic), 40, 0);
    assert_near(plumb_body_inertia(w, f->dynamic), 10 * inertia, ROUNDED(1e-4));
    assert_int_equal(plumb_body_reset_mass(w, f->dynamic), PLUMB_OK);
    assert_near(plumb_body_mass(w, f->dynamic), 4, ROUNDED(1e-6));
    assert_near(plumb_body_inertia(w, f->dynamic), inertia, ROUNDED(1e-6));

    plumb_body b = plumb_body_create(w, &(plumb_body_desc){ .mass = 2, .inertia = 6 });
    plumb_shape_create(w, b, &(plumb_shape_desc){ .kind = PLUMB_CIRCLE, .radius = 1 });
    assert_near(plumb_body_mass(w, b), 2, 0);
    assert_near(plumb_body_inertia(w, b), 6, 0);
    plumb_body_set_mass(w, b, 4);
    assert_near(plumb_body_inertia(w, b), 12, ROUNDED(1e-5));
    plumb_body_reset_mass(w, b);
    assert_near(plumb_body_mass(w, b), PI, ROUNDED(1e-5));
    assert_near(plumb_body_inertia(w, b), PI / 2, ROUNDED(1e-5));

    b = plumb_body_create(w, &(plumb_body_desc){ .mass = 2 });
    plumb_shape_create(w, b, &(plumb_shape_desc){ .kind = PLUMB_CIRCLE, .radius = 1 });
    assert_near(plumb_body_inertia(w, b), 1, 1e-6); // m r^2 / 2 with the given mass
}

static void densities_are_read_again_on_reset(void **state)
{
    fixture *f = *state;
    plumb_world *w = f->world;
    plumb_shape_set_material(w, f->box, f->wood); // density 2
    assert_near(plumb_body_mass(w, f->dynamic), 4, ROUNDED(1e-6));
    plumb_body_reset_mass(w, f->dynamic);
    assert_near(plumb_body_mass(w, f->dynamic), 8, ROUNDED(1e-6));
    plumb_material_set(w, f->wood, &(plumb_material_desc){ .density = 5 });
    assert_near(plumb_body_mass(w, f->dynamic), 8, ROUNDED(1e-6));
    plumb_body_reset_mass(w, f->dynamic);
    assert_near(plumb_body_mass(w, f->dynamic), 20, ROUNDED(1e-5));
}

static void fixed_rotation_stops_and_allows_turning(void **state)
{
    fixture *f = *state;
    plumb_world *w = f->world;
    plumb_body_set_angular_velocity(w, f->dynamic, 5);
    assert_int_equal(plumb_body_set_fixed_rotation(w, f->dynamic, true), PLUMB_OK);
    assert_near(plumb_body_angular_velocity(w, f->dynamic), 0, 0);
    assert_near(plumb_body_inertia(w, f->dynamic), 0, 0);
    plumb_body_apply_angular_impulse(w, f->dynamic, 100);
    assert_near(plumb_body_angular_velocity(w, f->dynamic), 0, 0);
    assert_int_equal(plumb_body_set_angular_velocity(w, f->dynamic, 0), PLUMB_OK);
    assert_int_equal(plumb_body_set_fixed_rotation(w, f->dynamic, false), PLUMB_OK);
    assert_near(plumb_body_inertia(w, f->dynamic), 32 / 12.0, ROUNDED(1e-5));
}

static void lines_have_no_mass(void **state)
{
    fixture *f = *state;
    plumb_world *w = f->world;
    const plumb_vec2 points[] = { { 3, 3 }, { 5, 3 }, { 5, 5 } };
    plumb_body b = plumb_body_create(w, &(plumb_body_desc){ 0 });
    plumb_shape_create(w, b,
                       &(plumb_shape_desc){ .kind = PLUMB_CHAIN, .points = points, .count = 3 });
    assert_near(plumb_body_mass(w, b), 1, 0);
    assert_near(plumb_body_inertia(w, b), 0, 0);
    assert_vec_near(plumb_body_local_center(w, b), 0, 0, 0);
}

static void shapes_are_listed_in_order_of_creation(void **state)
{
    fixture *f = *state;
    plumb_world *w = f->world;
    const plumb_vec2 points[] = { { 0, 0 }, { 1, 0 }, { 1, 1 }, { 0, 1 } };
    plumb_shape s[4] = { f->box };
    s[1] = plumb_shape_create(
        w, f->dynamic, &(plumb_shape_desc){ .kind = PLUMB_CHAIN, .points = points, .count = 4 });
    s[2] =
        plumb_shape_create(w, f->dynamic, &(plumb_shape_desc){ .kind = PLUMB_CIRCLE, .radius = 1 });
    s[3] =
        plumb_shape_create(w, f->dynamic, &(plumb_shape_desc){ .kind = PLUMB_CIRCLE, .radius = 2 });
    plumb_shape got[4];
    assert_int_equal(plumb_body_shapes(w, f->dynamic, got, 4), 4);
    assert_memory_equal(got, s, sizeof s);
    memset(got, 0, sizeof got);
    assert_int_equal(plumb_body_shapes(w, f->dynamic, got, 2), 4);
    assert_memory_equal(got, s, 2 * sizeof s[0]);
    assert_true(plumb_is_null(got[2]));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        API_TEST(a_zero_descriptor_is_a_dynamic_body_at_the_origin),
        API_TEST(a_descriptor_is_read_back),
        API_TEST(bad_handles_are_answered_with_zeros),
        API_TEST(destruction_takes_the_shapes_along),
        API_TEST(teleport_moves_at_once_and_keeps_velocity),
        API_TEST(a_kinematic_body_moves_by_its_velocity_alone),
        API_TEST(forces_last_one_step),
        API_TEST(impulses_act_at_once),
        API_TEST(mass_and_centre_follow_the_shapes),
        API_TEST(a_given_mass_scales_the_inertia),
        API_TEST(densities_are_read_again_on_reset),
        API_TEST(fixed_rotation_stops_and_allows_turning),
        API_TEST(lines_have_no_mass),
        API_TEST(shapes_are_listed_in_order_of_creation),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
