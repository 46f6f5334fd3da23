// test_api_friction.c - kinetic friction: mixing, systems that change it, who pays for it.
#include "contact_fixture.h"

// A box on a floor: friction of the contact while it rests, and a step after it was pushed to 1 m/s.
static void check_states(plumb_material_desc a, plumb_material_desc b,
                         const plumb_material_pair *pair, double sticks, double slides)
{
    plumb_world *w = flat_world((plumb_world_desc){ 0 });
    plumb_material ma = plumb_material_create(w, &a), mb = plumb_material_create(w, &b);
    assert_int_equal(plumb_material_pair_set(w, mb, ma, pair), PLUMB_OK);
    add_floor(w, ma);
    plumb_body box = plumb_body_create(w, &(plumb_body_desc){ .position = { 0, R(0.5) } });
    plumb_shape_create(
        w, box,
        &(plumb_shape_desc){ .kind = PLUMB_BOX, .half = { R(0.5), R(0.5) }, .material = mb });
    plumb_contact c;
    for (int i = 0; i < 2; ++i) {
        steps(w, 8);
        assert_int_equal(plumb_world_contacts(w, &c, 1), 1);
        assert_near(c.friction, i == 0 ? sticks : slides, ROUNDED(1e-6));
        plumb_body_set_velocity(w, box, (plumb_vec2){ 2, 0 });
    }
    const double v = (double)plumb_body_velocity(w, box).x;
    steps(w, 1);
    assert_near(v - (double)plumb_body_velocity(w, box).x, slides * 9.81 / 64, 1e-4);
    // It comes to rest, and sticks again.
    steps(w, 400);
    assert_int_equal(plumb_world_contacts(w, &c, 1), 1);
    assert_near(c.friction, sticks, ROUNDED(1e-6));
    plumb_world_destroy(w);
}

static void kinetic_friction_is_mixed_as_friction_is(void **state)
{
    (void)state;
    plumb_material_desc a = { .friction = R(0.4), .kinetic_friction = R(0.1) };
    plumb_material_desc b = { .friction = R(0.9), .kinetic_friction = R(0.4) };
    check_states(a, b, NULL, 0.6, 0.2);
    b.kinetic_friction = 0; // as its friction
    check_states(a, b, NULL, 0.6, 0.3);
    b.kinetic_friction = 5; // not above it
    check_states(a, b, NULL, 0.6, 0.6);
    b.kinetic_friction = R(0.4);
    a.friction_mix = PLUMB_MIX_MAX;
    check_states(a, b, NULL, 0.9, 0.4);
    check_states(a, b, &(plumb_material_pair){ .friction = R(0.5) }, 0.5, 0.5);
    check_states(a, b, &(plumb_material_pair){ .friction = R(0.5), .kinetic_friction = R(0.25) },
                 0.5, 0.25);
}

static void grease(const plumb_system_call *call)
{
    for (int i = 0; i < plumb_contact_edit_count(call->world); ++i) {
        plumb_contact_edit c;
        assert_int_equal(plumb_contact_edit_get(call->world, i, &c), PLUMB_OK);
        c.friction = R(0.25);
        assert_int_equal(plumb_contact_edit_set(call->world, i, &c), PLUMB_OK);
    }
}

// What a system sets is the friction of both states; a material that slides again has its own.
static void a_system_sets_the_friction_of_both_states(void **state)
{
    (void)state;
    for (int solver = 0; solver < 3; ++solver) {
        plumb_world *w = flat_world((plumb_world_desc){ .solver = (plumb_solver)solver });
        plumb_material m = plumb_material_create(
            w, &(plumb_material_desc){ .friction = R(0.5), .kinetic_friction = R(0.1) });
        add_floor(w, m);
        plumb_body box = plumb_body_create(w, &(plumb_body_desc){ .position = { 0, R(0.5) } });
        plumb_shape_create(
            w, box,
            &(plumb_shape_desc){ .kind = PLUMB_BOX, .half = { R(0.5), R(0.5) }, .material = m });
        plumb_system_create(
            w,
            &(plumb_system_desc){ .name = "grease", .phase = PLUMB_PHASE_CONTACTS, .run = grease });
        for (int i = 0; i < 2; ++i) {
            steps(w, 64);
            plumb_body_set_velocity(w, box, (plumb_vec2){ 4, 0 });
            steps(w, 8);
            const double v = (double)plumb_body_velocity(w, box).x;
            steps(w, 8);
            assert_near(v - (double)plumb_body_velocity(w, box).x, (i == 0 ? 0.25 : 0.1) * 9.81 / 8,
                        0.01);
            if (i == 0) {
                plumb_system_enable(w, "grease", false);
            }
        }
        plumb_world_destroy(w);
    }
}

static bool has_variant(plumb_world *w)
{
    plumb_pass_info rows[128];
    const int count = plumb_world_schedule(w, rows, 128);
    for (int i = 0; i < count; ++i) {
        for (int k = 0; k < rows[i].variant_count && strcmp(rows[i].name, "contacts") == 0; ++k) {
            if (strcmp(rows[i].variants[k], "kinetic friction") == 0) {
                return true;
            }
        }
    }
    return false;
}

static void only_who_has_it_pays(void **state)
{
    (void)state;
    plumb_world *w = flat_world((plumb_world_desc){ 0 });
    plumb_material m = plumb_material_create(w, &(plumb_material_desc){ .friction = R(0.5) });
    add_floor(w, m);
    add_disc(w, 0, 0.5, (plumb_shape_desc){ .material = m }, NULL);
    steps(w, 1);
    assert_false(has_variant(w));
    plumb_material_set(w, m, &(plumb_material_desc){ .friction = 1, .kinetic_friction = R(0.5) });
    steps(w, 1);
    assert_true(has_variant(w));
    plumb_material_set(w, m, &(plumb_material_desc){ .friction = 1, .kinetic_friction = 1 });
    steps(w, 1);
    assert_true(!has_variant(w)); // one friction
    plumb_world_destroy(w);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(kinetic_friction_is_mixed_as_friction_is),
        cmocka_unit_test(a_system_sets_the_friction_of_both_states),
        cmocka_unit_test(only_who_has_it_pays),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
