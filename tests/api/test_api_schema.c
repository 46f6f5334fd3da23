// test_api_schema.c - properties as data. What follows from each row is in tests/unit/test_scene_schema.c.
#include "world_fixture.h"

static void tables_have_rows(void **state)
{
    (void)state;
    for (int t = 0; t < PLUMB_TABLE_COUNT; ++t) {
        int count = -1;
        const plumb_property *rows = plumb_properties((plumb_property_table)t, &count);
        assert_true(count > 0);
        assert_ptr_equal(plumb_properties((plumb_property_table)t, NULL), rows);
        for (int i = 0; i < count; ++i) {
            assert_ptr_equal(plumb_property_find((plumb_property_table)t, rows[i].name), &rows[i]);
            assert_true(rows[i].text[0] != '\0' && rows[i].unit[0] != '\0');
            assert_true(rows[i].low < rows[i].high);
        }
        assert_null(plumb_property_find((plumb_property_table)t, "nothing"));
        assert_null(plumb_property_find((plumb_property_table)t, NULL));
    }
    int count = -1;
    assert_null(plumb_properties(PLUMB_TABLE_COUNT, &count));
    assert_int_equal(count, 0);
    assert_null(plumb_property_find(PLUMB_TABLE_COUNT, "friction"));
}

static void zero_is_said_by_a_member_of_its_own(void **state)
{
    (void)state;
    plumb_material_desc desc = { 0 };
    const plumb_property *friction = plumb_property_find(PLUMB_TABLE_MATERIAL, "friction");
    assert_near(plumb_property_read(friction, &desc, 0), 0.6, 0);
    plumb_property_write(friction, &desc, 0, 0);
    assert_true(desc.frictionless && desc.friction == 0);
    assert_near(plumb_property_read(friction, &desc, 0), 0, 0);
    plumb_property_write(friction, &desc, 0, 0.5);
    assert_true(!desc.frictionless && desc.friction == R(0.5));
    assert_near(plumb_property_read(friction, &desc, 0), 0.5, 0);
    const plumb_property *mix = plumb_property_find(PLUMB_TABLE_MATERIAL, "friction_mix");
    plumb_property_write(mix, &desc, 0, PLUMB_MIX_MIN);
    assert_int_equal(desc.friction_mix, PLUMB_MIX_MIN);
    assert_near(plumb_property_read(mix, &desc, 0), PLUMB_MIX_MIN, 0);
}

static void a_body_is_read_as_a_descriptor(void **state)
{
    fixture *f = *state;
    plumb_body_desc desc, want = { .type = PLUMB_KINEMATIC,
                                   .position = { 3, 4 },
                                   .velocity = { 1, 2 },
                                   .gravity_scale = R(0.5),
                                   .time_scale = R(0.25),
                                   .user_data = f };
    plumb_body made = plumb_body_create(f->world, &want);
    assert_int_equal(plumb_body_settings(f->world, made, &desc), PLUMB_OK);
    assert_int_equal(desc.type, PLUMB_KINEMATIC);
    assert_vec_near(desc.position, 3, 4, 0);
    assert_vec_near(desc.velocity, 1, 2, 0);
    assert_near(desc.gravity_scale, 0.5, 0);
    assert_near(desc.time_scale, 0.25, 0);
    assert_ptr_equal(desc.user_data, f);
    assert_int_equal(plumb_body_set_gravity_scale(f->world, made, 0), PLUMB_OK);
    assert_int_equal(plumb_body_settings(f->world, made, &desc), PLUMB_OK);
    assert_true(desc.no_gravity);
    REFUSED(E_HANDLE, "plumb_body_settings: body is null; it must be a live body",
            plumb_body_settings(f->world, NO_BODY, &desc));
    REFUSED(E_NULL, "plumb_body_settings: desc is null; it must be given",
            plumb_body_settings(f->world, made, NULL));
    assert_int_equal(plumb_body_settings(NULL, made, &desc), PLUMB_E_NULL);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(tables_have_rows),
        cmocka_unit_test(zero_is_said_by_a_member_of_its_own),
        API_TEST(a_body_is_read_as_a_descriptor),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
