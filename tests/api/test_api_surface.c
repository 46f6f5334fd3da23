// test_api_surface.c - what materials do at contacts: belts, rolling resistance, mixing, the pair
// table.
#include "contact_fixture.h"

static void a_conveyor_carries_a_box_at_its_speed(void **state)
{
    (void)state;
    for (int solver = 0; solver < 3; ++solver) {
        plumb_world *w = flat_world((plumb_world_desc){ .solver = (plumb_solver)solver });
        plumb_material belt = plumb_material_create(
            w, &(plumb_material_desc){ .friction = R(0.5), .surface_speed = 2 });
        add_floor(w, belt);
        plumb_body box = plumb_body_create(w, &(plumb_body_desc){ .position = { 0, R(0.5) } });
        plumb_shape_create(w, box,
                           &(plumb_shape_desc){ .kind = PLUMB_BOX, .half = { R(0.5), R(0.5) } });
        // A capsule is A to the belt's B, a box is B to the belt's A.
        const plumb_vec2 ends[] = { { R(-0.5), 0 }, { R(0.5), 0 } };
        plumb_body rod = plumb_body_create(w, &(plumb_body_desc){ .position = { -9, R(0.25) } });
        plumb_shape_create(
            w, rod,
            &(plumb_shape_desc){
                .kind = PLUMB_CAPSULE, .points = ends, .count = 2, .radius = R(0.25) });
        steps(w, 200);
        assert_near(plumb_body_velocity(w, box).x, 2, ROUNDED(1e-3));
        assert_near(plumb_body_velocity(w, rod).x, 2, ROUNDED(1e-3));
        // It caught up at mu g: 2 / (sqrt(0.5 x 0.6) 9.81) s, and lost half of that way.
        double mu = sqrt(0.3), t = 200.0 / 64;
        double way = 2 * t - 2 * 2 / (2 * mu * 9.81);
        assert_near(plumb_body_position(w, box).x, way, solver == 0 ? 0.02 : 0.1);
        plumb_world_destroy(w);
    }
}

static void turn_belts(const plumb_system_call *call)
{
    for (int i = 0; i < plumb_contact_edit_count(call->world); ++i) {
        plumb_contact_edit c;
        assert_int_equal(plumb_contact_edit_get(call->world, i, &c), PLUMB_OK);
        assert_true(c.surface_speed == 2);
        c.surface_speed = -1;
        assert_int_equal(plumb_contact_edit_set(call->world, i, &c), PLUMB_OK);
    }
}

// Whichever way y points: positive is to +x, in materials and in edits of contacts.
static void belts_run_to_the_right_of_the_screen(void **state)
{
    (void)state;
    for (int k = 0; k < 4; ++k) {
        const plumb_real down = k % 2 == 0 ? 1 : -1;
        plumb_world *w =
            flat_world((plumb_world_desc){ .y_axis = k % 2 == 0 ? PLUMB_Y_UP : PLUMB_Y_DOWN });
        plumb_material belt =
            plumb_material_create(w, &(plumb_material_desc){ .surface_speed = 2 });
        plumb_body floor = plumb_body_create(
            w, &(plumb_body_desc){ .type = PLUMB_STATIC, .position = { 0, -down } });
        plumb_shape_create(
            w, floor,
            &(plumb_shape_desc){ .kind = PLUMB_BOX, .half = { 50, 1 }, .material = belt });
        plumb_body box =
            plumb_body_create(w, &(plumb_body_desc){ .position = { 0, down * R(0.5) } });
        plumb_shape_create(w, box,
                           &(plumb_shape_desc){ .kind = PLUMB_BOX, .half = { R(0.5), R(0.5) } });
        if (k >= 2) {
            const plumb_system_desc turn = { .name = "turn",
                                             .phase = PLUMB_PHASE_CONTACTS,
                                             .run = turn_belts };
            assert_int_equal(plumb_system_create(w, &turn), PLUMB_OK);
        }
        steps(w, 200);
        assert_near(plumb_body_velocity(w, box).x, k < 2 ? 2 : -1, ROUNDED(1e-3));
        plumb_world_destroy(w);
    }
}

// A disc that rolls without slipping is slowed by a = f g / r / (1 + 1/2), and stops after v^2 /
// 2a.
static void a_rolling_disc_stops_where_it_should(void **state)
{
    (void)state;
    for (int solver = 0; solver < 3; ++solver) {
        plumb_world *w = flat_world((plumb_world_desc){ .solver = (plumb_solver)solver });
        plumb_material soft = plumb_material_create(
            w, &(plumb_material_desc){ .friction = 1, .rolling_resistance = R(0.02) });
        add_floor(w, soft);
        plumb_body disc = add_disc(w, 0, 0.5, (plumb_shape_desc){ 0 }, NULL);
        plumb_body_set_velocity(w, disc, plumb_v2(2, 0));
        plumb_body_set_angular_velocity(w, disc, -4);
        steps(w, 64 * 12);
        double a = 0.02 * 9.81 / 0.5 / 1.5;
        assert_near(plumb_body_position(w, disc).x, 2 * 2 / (2 * a), 0.05);
        assert_near(plumb_body_velocity(w, disc).x, 0, ROUNDED(1e-4));
        plumb_world_destroy(w);
    }
}

// tan of the slope below f / r: it stays; above: it rolls.
static void rolling_resistance_holds_a_disc_on_a_slope(void **state)
{
    (void)state;
    for (int i = 0; i < 2; ++i) {
        double slope = i == 0 ? 0.03 : 0.06; // f / r is 0.04
        plumb_world *w = flat_world((plumb_world_desc){ .gravity = { R(9.81 * slope), R(-9.81) } });
        plumb_material soft = plumb_material_create(
            w, &(plumb_material_desc){ .friction = 1, .rolling_resistance = R(0.02) });
        add_floor(w, soft);
        plumb_body disc = add_disc(w, 0, 0.5, (plumb_shape_desc){ 0 }, NULL);
        steps(w, 640);
        double x = plumb_body_position(w, disc).x;
        double t = 10, expected = i == 0 ? 0 : 9.81 * (0.06 - 0.04) / 1.5 * t * t / 2;
        assert_near(x, expected, i == 0 ? 1e-3 : 0.05 * expected);
        plumb_world_destroy(w);
    }
}

static void contact_numbers(plumb_material_desc a, plumb_material_desc b,
                            const plumb_material_pair *pair, double friction, double restitution)
{
    plumb_world *w = flat_world((plumb_world_desc){ 0 });
    plumb_material ma = plumb_material_create(w, &a), mb = plumb_material_create(w, &b);
    assert_int_equal(plumb_material_pair_set(w, mb, ma, pair), PLUMB_OK);
    add_floor(w, ma);
    add_disc(w, 0, 0.5, (plumb_shape_desc){ .material = mb }, NULL);
    steps(w, 1);
    plumb_contact c;
    assert_int_equal(plumb_world_contacts(w, &c, 1), 1);
    assert_near(c.friction, friction, ROUNDED(1e-6));
    assert_near(c.restitution, restitution, ROUNDED(1e-6));
    plumb_world_destroy(w);
}

static void materials_mix_by_rule_or_table(void **state)
{
    (void)state;
    plumb_material_desc a = { .friction = R(0.4), .restitution = R(0.2) };
    plumb_material_desc b = { .friction = R(0.9), .restitution = R(0.8) };
    contact_numbers(a, b, NULL, 0.6, 0.8);
    a.friction_mix = PLUMB_MIX_MIN;
    a.restitution_mix = PLUMB_MIX_AVERAGE;
    contact_numbers(a, b, NULL, 0.4, 0.5);
    b.friction_mix = PLUMB_MIX_MAX; // the later rule holds
    b.restitution_mix = PLUMB_MIX_GEOMETRIC;
    contact_numbers(a, b, NULL, 0.9, 0.4);
    b.friction_mix = PLUMB_MIX_MULTIPLY;
    a.friction_mix = PLUMB_MIX_GEOMETRIC;
    contact_numbers(a, b, NULL, 0.36, 0.4);
    contact_numbers(a, b, &(plumb_material_pair){ .friction = 2, .restitution = 1 }, 2, 1);
}

static void the_pair_table_is_kept_up(void **state)
{
    fixture *f = *state;
    plumb_material_pair p = { .friction = 1, .rolling_resistance = R(0.25) }, got = { 0 };
    assert_int_equal(plumb_material_pair_set(W, f->wood, NO_MATERIAL, &p), PLUMB_OK);
    assert_int_equal(plumb_material_pair_set(W, f->used, f->used, &p), PLUMB_OK);
    p.friction = 3;
    assert_int_equal(plumb_material_pair_set(W, NO_MATERIAL, f->wood, &p), PLUMB_OK);
    assert_int_equal(plumb_material_pair_get(W, f->wood, NO_MATERIAL, &got), PLUMB_OK);
    assert_near(got.friction, 3, 0);
    assert_near(got.rolling_resistance, 0.25, 0);
    REFUSED(E_MISSING,
            "plumb_material_pair_get: nothing is set for a and b; their materials are mixed",
            plumb_material_pair_get(W, f->wood, f->used, &got));
    // Rows move, slots are taken anew: nothing of the dead material is left, the others keep
    // theirs.
    assert_int_equal(plumb_material_destroy(W, f->wood), PLUMB_OK);
    plumb_material next = plumb_material_create(W, &(plumb_material_desc){ 0 });
    assert_int_equal(plumb_material_pair_get(W, next, NO_MATERIAL, &got), PLUMB_E_MISSING);
    assert_int_equal(plumb_material_pair_get(W, f->used, f->used, &got), PLUMB_OK);
    assert_near(got.friction, 1, 0);
    assert_int_equal(plumb_material_pair_set(W, f->used, f->used, NULL), PLUMB_OK);
    assert_int_equal(plumb_material_pair_get(W, f->used, f->used, &got), PLUMB_E_MISSING);
}

// Two materials without bounce of their own, elastic by the table: as elastic as any.
static void a_pair_can_be_elastic_by_the_table(void **state)
{
    (void)state;
    plumb_world *w = flat_world((plumb_world_desc){ 0 });
    assert_int_equal(plumb_material_pair_set(w, NO_MATERIAL, NO_MATERIAL,
                                             &(plumb_material_pair){ .restitution = 1 }),
                     PLUMB_OK);
    add_floor(w, NO_MATERIAL);
    plumb_body disc = add_disc(w, 0, 2.5, (plumb_shape_desc){ 0 }, NULL);
    double top = 0;
    for (int i = 0; i < 128; ++i) {
        steps(w, 1);
        top = i > 64 ? fmax(top, plumb_body_position(w, disc).y) : 0;
    }
    assert_near(top, 2.5, 0.01);
    plumb_world_destroy(w);
}

// Belts, rolling resistance, counted impulses: every number of lanes gives the same bits.
static uint64_t digest_at(int width)
{
    plumb_world *w = flat_world((plumb_world_desc){ .simd_width = width, .hit_speed = 1 });
    plumb_material belt =
        plumb_material_create(w, &(plumb_material_desc){ .friction = R(0.5),
                                                         .restitution = R(0.25),
                                                         .surface_speed = 1,
                                                         .rolling_resistance = R(0.01) });
    add_floor(w, belt);
    for (int i = 0; i < 37; ++i) {
        add_disc(w, i % 6 * 0.9, 1 + i / 6 * 1.1, (plumb_shape_desc){ 0 }, NULL);
    }
    uint64_t digest = 0;
    for (int i = 0; i < 128; ++i) {
        steps(w, 1);
        int count;
        const plumb_contact_hit *hits = plumb_world_hit_events(w, &count);
        for (int k = 0; k < count; ++k) {
            digest_bytes(&digest, &hits[k].impulse, sizeof hits[k].impulse);
        }
    }
    digest ^= digest_world(w);
    plumb_world_destroy(w);
    return digest;
}

static void every_width_gives_the_same_bits(void **state)
{
    (void)state;
    uint64_t digest = digest_at(4);
    assert_true(digest_at(8) == digest && digest_at(16) == digest);
}

//---- refusals ------------------------------------------------------------------------------------

// A disc under a ceiling: how it comes by its pull-off force, and what its end is.
static plumb_world *hang(plumb_material_desc disc, plumb_material_desc ceiling, plumb_body *body,
                         plumb_material made[2])
{
    plumb_world *w = flat_world((plumb_world_desc){ 0 });
    made[0] = plumb_material_create(w, &disc);
    made[1] = plumb_material_create(w, &ceiling);
    plumb_body top = plumb_body_create(w, &(plumb_body_desc){ .type = PLUMB_STATIC });
    plumb_shape_create(
        w, top,
        &(plumb_shape_desc){
            .kind = PLUMB_BOX, .half = { 5, 1 }, .center = { 0, R(1.499) }, .material = made[1] });
    *body = add_disc(w, 0, 0, (plumb_shape_desc){ .material = made[0] }, NULL);
    plumb_body_set_mass(w, *body, 1);
    return w;
}

static bool holds(plumb_world *w, plumb_body body)
{
    plumb_body_set_gravity_scale(w, body, 0);
    plumb_body_set_velocity(w, body, plumb_v2(0, R(0.1)));
    steps(w, 8); // to touch
    plumb_body_set_gravity_scale(w, body, 1);
    steps(w, 128);
    return plumb_body_position(w, body).y > R(-0.1);
}

static void adhesion_is_mixed(void **state)
{
    (void)state;
    plumb_body b;
    plumb_material m[2];
    const struct {
        plumb_real disc, ceiling;
        plumb_mix mix;
        bool holds;
    } cases[] = { { 0, 20, PLUMB_MIX_DEFAULT, true }, { 20, 0, PLUMB_MIX_DEFAULT, true },
                  { 5, 9, PLUMB_MIX_DEFAULT, false }, { 20, 0, PLUMB_MIX_MIN, false },
                  { 20, 2, PLUMB_MIX_AVERAGE, true }, { 20, 1, PLUMB_MIX_GEOMETRIC, false },
                  { 4, 4, PLUMB_MIX_MULTIPLY, true } };
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; ++i) {
        plumb_world *w =
            hang((plumb_material_desc){ .adhesion = cases[i].disc, .adhesion_mix = cases[i].mix },
                 (plumb_material_desc){ .adhesion = cases[i].ceiling }, &b, m);
        assert_int_equal(holds(w, b), cases[i].holds);
        plumb_world_destroy(w);
    }
    plumb_world *w =
        hang((plumb_material_desc){ .adhesion = 20 }, (plumb_material_desc){ 0 }, &b, m);
    plumb_material_desc d;
    plumb_material_settings(w, m[0], &d);
    assert_near(d.adhesion, 20, 0);
    assert_int_equal(d.adhesion_mix, PLUMB_MIX_DEFAULT);
    plumb_material_pair_set(w, m[0], m[1], &(plumb_material_pair){ .adhesion = 5 });
    assert_false(holds(w, b));
    plumb_world_destroy(w);
    w = hang((plumb_material_desc){ 0 }, (plumb_material_desc){ 0 }, &b, m);
    plumb_material_pair_set(w, m[0], m[1], &(plumb_material_pair){ .adhesion = 15 });
    assert_true(holds(w, b));
    plumb_world_destroy(w);
}

// It hangs until pulled off: one begin, no end; then one end, and it is not drawn back.
static void what_sticks_lets_go_with_an_event(void **state)
{
    (void)state;
    plumb_body b;
    plumb_material m[2];
    plumb_world *w = hang((plumb_material_desc){ .adhesion = 30, .restitution = R(0.5) },
                          (plumb_material_desc){ 0 }, &b, m);
    int count, begins = 0, ends = 0;
    for (int i = 0; i < 300; ++i) {
        if (i == 100) {
            assert_near(plumb_body_position(w, b).y, 0, 0.01);
            assert_int_equal(begins, 1);
            assert_int_equal(ends, 0);
        }
        if (i >= 100 && i < 150) {
            plumb_body_apply_force_center(w, b, plumb_v2(0, -25)); // 34.8 N in all
        }
        steps(w, 1);
        plumb_world_begin_events(w, &count);
        begins += count;
        plumb_world_end_events(w, &count);
        ends += count;
    }
    assert_int_equal(begins, 1);
    assert_int_equal(ends, 1);
    assert_true(plumb_body_position(w, b).y < -5);
    plumb_world_destroy(w);
}

static void glue(const plumb_system_call *call)
{
    int count = plumb_contact_edit_count(call->world);
    for (int i = 0; i < count; ++i) {
        plumb_contact_edit edit;
        assert_int_equal(plumb_contact_edit_get(call->world, i, &edit), PLUMB_OK);
        edit.adhesion = edit.touching ? *(plumb_real *)call->context : 0;
        assert_int_equal(plumb_contact_edit_set(call->world, i, &edit), PLUMB_OK);
        edit.adhesion = -1;
        assert_int_equal(plumb_contact_edit_set(call->world, i, &edit), PLUMB_E_RANGE);
        assert_string_equal(plumb_world_error(call->world).message,
                            "plumb_contact_edit_set: adhesion is -1; it must be at least 0");
    }
}

static void a_system_can_glue(void **state)
{
    (void)state;
    for (int i = 0; i < 2; ++i) {
        plumb_body b;
        plumb_material m[2];
        plumb_world *w = hang((plumb_material_desc){ 0 }, (plumb_material_desc){ 0 }, &b, m);
        plumb_real force = i == 0 ? 12 : 8;
        plumb_system_create(
            w, &(plumb_system_desc){
                   .name = "glue", .phase = PLUMB_PHASE_CONTACTS, .run = glue, .context = &force });
        assert_int_equal(holds(w, b), i == 0);
        plumb_world_destroy(w);
    }
}

// Locked and sticky bodies take the special kernel: the same bits at every width.
static void special_contacts_give_the_same_bits(void **state)
{
    (void)state;
    uint64_t digest[3];
    for (int k = 0; k < 3; ++k) {
        plumb_world *w = flat_world((plumb_world_desc){ .simd_width = 4 << k });
        plumb_material tar =
            plumb_material_create(w, &(plumb_material_desc){ .friction = R(0.4),
                                                             .kinetic_friction = R(0.2),
                                                             .adhesion = 3,
                                                             .rolling_resistance = R(0.01) });
        add_floor(w, tar);
        for (int i = 0; i < 60; ++i) {
            plumb_shape_desc d = { .material = i % 2 == 0 ? tar : NO_MATERIAL };
            plumb_body b = add_disc(w, i % 10 * 0.9 + 0.03 * i, 0.6 + i / 10 * 0.95, d, NULL);
            plumb_body_set_locks(w, b,
                                 (plumb_axis_locks){ .x = i % 7 == 0, .rotation = i % 5 == 0 });
            plumb_body_set_time_scale(w, b, i % 11 == 0 ? R(0.5) : 1);
            plumb_body_set_damping(w, b, i % 3 == 0 ? R(0.2) : 0, 0);
        }
        steps(w, 200);
        digest[k] = digest_world(w);
        plumb_world_destroy(w);
    }
    assert_true(digest[0] == digest[1] && digest[0] == digest[2]);
}

static void wrong_materials_and_speeds_are_refused(void **state)
{
    fixture *f = *state;
    plumb_material_desc d = { .rolling_resistance = -1 };
    REFUSED(E_RANGE, "plumb_material_create: rolling_resistance is -1; it must be at least 0",
            made(W, plumb_material_create(W, &d)));
    d = (plumb_material_desc){ .kinetic_friction = R(-0.5) };
    REFUSED(E_RANGE, "plumb_material_create: kinetic_friction is -0.5; it must be 0 to 10",
            made(W, plumb_material_create(W, &d)));
    d = (plumb_material_desc){ .kinetic_friction = R(NAN) };
    REFUSED(E_NOT_FINITE, "plumb_material_set: kinetic_friction is nan; it must be finite",
            plumb_material_set(W, f->wood, &d));
    d = (plumb_material_desc){ .surface_speed = R(INFINITY) };
    REFUSED(E_NOT_FINITE, "plumb_material_set: surface_speed is inf; it must be finite",
            plumb_material_set(W, f->wood, &d));
    d = (plumb_material_desc){ .friction_mix = (plumb_mix)9 };
    REFUSED(E_RANGE,
            "plumb_material_set: friction_mix is 9; it must be one of "
            "default|average|geometric|multiply|min|max",
            plumb_material_set(W, f->wood, &d));
    d = (plumb_material_desc){ .restitution_mix = (plumb_mix)6 };
    REFUSED(E_RANGE,
            "plumb_material_set: restitution_mix is 6; it must be one of "
            "default|average|geometric|multiply|min|max",
            plumb_material_set(W, f->wood, &d));
    plumb_material_pair p = { .kinetic_friction = 11 };
    REFUSED(E_RANGE, "plumb_material_pair_set: pair.kinetic_friction is 11; it must be 0 to 10",
            plumb_material_pair_set(W, f->wood, f->used, &p));
    p = (plumb_material_pair){ .friction = 11 };
    REFUSED(E_RANGE, "plumb_material_pair_set: pair.friction is 11; it must be 0 to 10",
            plumb_material_pair_set(W, f->wood, f->used, &p));
    p = (plumb_material_pair){ .restitution = R(NAN) };
    REFUSED(E_NOT_FINITE, "plumb_material_pair_set: pair.restitution is nan; it must be finite",
            plumb_material_pair_set(W, f->wood, f->used, &p));
    p = (plumb_material_pair){ .rolling_resistance = -2 };
    REFUSED(E_RANGE,
            "plumb_material_pair_set: pair.rolling_resistance is -2; it must be at least 0",
            plumb_material_pair_set(W, f->wood, f->used, &p));
    p = (plumb_material_pair){ .adhesion = -2 };
    REFUSED(E_RANGE, "plumb_material_pair_set: pair.adhesion is -2; it must be at least 0",
            plumb_material_pair_set(W, f->wood, f->used, &p));
    REFUSED(E_RANGE, "plumb_material_set: adhesion is -1; it must be at least 0",
            plumb_material_set(W, f->wood, &(plumb_material_desc){ .adhesion = -1 }));
    REFUSED(E_RANGE,
            "plumb_material_set: adhesion_mix is 9; it must be one of "
            "default|average|geometric|multiply|min|max",
            plumb_material_set(W, f->wood, &(plumb_material_desc){ .adhesion_mix = (plumb_mix)9 }));
    REFUSED(E_HANDLE, "plumb_material_pair_set: a is a body; it must be a live material or null",
            plumb_material_pair_set(W, (plumb_material){ f->fixed.entity }, f->used, NULL));
    REFUSED(E_HANDLE, "plumb_material_pair_get: b is a body; it must be a live material or null",
            plumb_material_pair_get(W, f->used, (plumb_material){ f->fixed.entity }, &p));
    REFUSED(E_NULL, "plumb_material_pair_get: pair is null; it must be given",
            plumb_material_pair_get(W, f->used, f->used, NULL));
    REFUSED(E_RANGE, "plumb_world_set_hit_speed: speed is -1; it must be at least 0",
            plumb_world_set_hit_speed(W, -1));
    REFUSED(E_NOT_FINITE, "plumb_world_set_hit_speed: speed is nan; it must be finite",
            plumb_world_set_hit_speed(W, R(NAN)));
    plumb_world *none;
    assert_int_equal(plumb_world_create(&(plumb_world_desc){ .hit_speed = -1 }, &none),
                     PLUMB_E_RANGE);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_conveyor_carries_a_box_at_its_speed),
        cmocka_unit_test(belts_run_to_the_right_of_the_screen),
        cmocka_unit_test(a_rolling_disc_stops_where_it_should),
        cmocka_unit_test(rolling_resistance_holds_a_disc_on_a_slope),
        cmocka_unit_test(materials_mix_by_rule_or_table),
        API_TEST(the_pair_table_is_kept_up),
        cmocka_unit_test(a_pair_can_be_elastic_by_the_table),
        cmocka_unit_test(every_width_gives_the_same_bits),
        cmocka_unit_test(adhesion_is_mixed),
        cmocka_unit_test(what_sticks_lets_go_with_an_event),
        cmocka_unit_test(a_system_can_glue),
        cmocka_unit_test(special_contacts_give_the_same_bits),
        API_TEST(wrong_materials_and_speeds_are_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
