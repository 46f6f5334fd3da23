// test_api_gone.c - end events of touches whose shapes went: destroyed, disabled, made anew.
#include "contact_fixture.h"

#define BOX  ((plumb_shape_desc){ .kind = PLUMB_BOX, .half = { R(0.5), R(0.5) } })
#define MOST 64

typedef struct ends {
    int count;
    plumb_contact_end event[MOST];
} ends;

static ends step(plumb_world *w)
{
    ends e = { .count = 0 };
    assert_int_equal(plumb_world_step(w, DT), PLUMB_OK);
    const plumb_contact_end *events = plumb_world_end_events(w, &e.count);
    assert_in_range(e.count, 0, MOST);
    for (int i = 0; i < e.count; ++i) {
        e.event[i] = events[i];
    }
    return e;
}

static bool names(const ends *e, plumb_shape a, plumb_shape b)
{
    for (int i = 0; i < e->count; ++i) {
        const plumb_contact_end *c = &e->event[i];
        if ((plumb_same(c->shape_a, a) && plumb_same(c->shape_b, b)) ||
            (plumb_same(c->shape_a, b) && plumb_same(c->shape_b, a))) {
            return true;
        }
    }
    return false;
}

static void a_destroyed_body_ends_its_touches(void **state)
{
    (void)state;
    plumb_world *w = flat_world((plumb_world_desc){ 0 });
    plumb_shape floor = add_floor(w, NO_MATERIAL), discs[5];
    plumb_body bodies[5];
    for (int i = 0; i < 5; ++i) {
        bodies[i] = add_disc(w, 3 * i, 0.5, (plumb_shape_desc){ 0 }, &discs[i]);
    }
    steps(w, 30);
    plumb_body_destroy(w, bodies[1]);
    plumb_body_destroy(w, bodies[3]);
    // Their slots are taken anew at once, at the same place.
    plumb_shape fresh;
    add_disc(w, 9, 0.5, (plumb_shape_desc){ 0 }, &fresh);
    ends e = step(w);
    assert_int_equal(e.count, 2);
    assert_true(names(&e, floor, discs[1]) && names(&e, floor, discs[3]));
    assert_false(plumb_shape_valid(w, discs[1]));
    for (int i = 0; i < e.count; ++i) {
        bool one =
            plumb_same(e.event[i].body_a, bodies[1]) || plumb_same(e.event[i].body_b, bodies[1]);
        bool other =
            plumb_same(e.event[i].body_a, bodies[3]) || plumb_same(e.event[i].body_b, bodies[3]);
        assert_true(one || other);
    }
    int begins;
    const plumb_contact_begin *b = plumb_world_begin_events(w, &begins);
    assert_int_equal(begins, 1);
    assert_true(plumb_same(b->shape_a, fresh) || plumb_same(b->shape_b, fresh));
    e = step(w);
    assert_int_equal(e.count, 0);
    plumb_world_destroy(w);
}

// The last two shapes: nothing is left that could collide, and still the end is told, once.
static void the_last_touch_ends_too(void **state)
{
    (void)state;
    for (int which = 0; which < 4; ++which) {
        plumb_world *w = flat_world((plumb_world_desc){ 0 });
        plumb_shape floor = add_floor(w, NO_MATERIAL), disc;
        plumb_body body = add_disc(w, 0, 0.5, (plumb_shape_desc){ 0 }, &disc);
        steps(w, 30);
        if (which == 0) {
            plumb_body_destroy(w, body);
        } else if (which == 1) {
            plumb_shape_destroy(w, floor);
        } else if (which == 2) {
            plumb_body_set_enabled(w, body, false);
        } else {
            plumb_body_set_type(w, body, PLUMB_STATIC);
        }
        ends e = step(w);
        assert_int_equal(e.count, 1);
        assert_true(names(&e, floor, disc));
        e = step(w);
        assert_int_equal(e.count, 0);
        assert_int_equal(plumb_world_stats(w).pair_count, 0);
        plumb_world_destroy(w);
    }
}

// A chain of several pieces ends once, whichever side goes; what never touched does not end.
static void shapes_of_several_pieces_end_once(void **state)
{
    (void)state;
    for (int which = 0; which < 3; ++which) {
        plumb_world *w =
            flat_world((plumb_world_desc){ .hit_speed = which == 2 ? R(1) : 0, .no_sleep = true });
        plumb_vec2 points[12];
        for (int i = 0; i < 12; ++i) {
            points[i] = plumb_v2(R(i * 0.4 - 2.2), 0);
        }
        plumb_body ground = plumb_body_create(w, &(plumb_body_desc){ .type = PLUMB_STATIC });
        plumb_shape chain = plumb_shape_create(
            w, ground, &(plumb_shape_desc){ .kind = PLUMB_CHAIN, .points = points, .count = 12 });
        plumb_body body = plumb_body_create(w, &(plumb_body_desc){ .position = { 0, R(0.5) } });
        plumb_shape box = plumb_shape_create(w, body, &BOX);
        plumb_shape far = plumb_shape_create(w, ground,
                                             &(plumb_shape_desc){ .kind = PLUMB_CIRCLE,
                                                                  .radius = R(0.2),
                                                                  .center = { R(0.75), R(0.5) } });
        steps(w, 30);
        if (which == 0) {
            plumb_body_destroy(w, body);
        } else {
            plumb_body_destroy(w, ground);
        }
        ends e = step(w);
        assert_int_equal(e.count, 1);
        assert_true(names(&e, chain, box));
        assert_false(names(&e, far, box));
        e = step(w);
        assert_int_equal(e.count, 0);
        plumb_world_destroy(w);
    }
}

// Destroyed and made in one go, several times over, between two steps.
static void slots_taken_anew_do_not_confuse(void **state)
{
    (void)state;
    plumb_world *w = flat_world((plumb_world_desc){ 0 });
    plumb_shape floor = add_floor(w, NO_MATERIAL), disc;
    plumb_body body = add_disc(w, 0, 0.5, (plumb_shape_desc){ 0 }, &disc);
    steps(w, 30);
    for (int round = 0; round < 20; ++round) {
        plumb_shape touched = disc;
        for (int k = 0; k < 3; ++k) {
            plumb_body_destroy(w, body);
            body = add_disc(w, 0, 0.5, (plumb_shape_desc){ 0 }, &disc);
        }
        ends e = step(w);
        assert_int_equal(e.count, 1);
        assert_true(names(&e, floor, touched));
        e = step(w);
        assert_int_equal(e.count, 0);
    }
    plumb_world_destroy(w);
}

static void a_new_form_touches_anew(void **state)
{
    (void)state;
    plumb_world *w = flat_world((plumb_world_desc){ 0 });
    plumb_shape floor = add_floor(w, NO_MATERIAL), disc;
    int tag = 0;
    plumb_body body =
        add_disc(w, 0, 0.5, (plumb_shape_desc){ .user_data = &tag, .density = 3 }, &disc);
    steps(w, 30);
    assert_int_equal(plumb_shape_set_geometry(w, disc, &BOX), PLUMB_OK);
    assert_true(plumb_shape_valid(w, disc));
    assert_int_equal(plumb_shape_get_kind(w, disc), PLUMB_BOX);
    assert_ptr_equal(plumb_shape_user_data(w, disc), &tag);
    assert_near(plumb_shape_density(w, disc), 3, 0);
    assert_near(plumb_body_mass(w, body), 3, ROUNDED(1e-5));
    assert_int_equal(plumb_body_shapes(w, body, NULL, 0), 1);
    assert_int_equal(plumb_world_stats(w).shape_count, 2);
    ends e = step(w);
    assert_true(e.count == 1 && names(&e, floor, disc));
    steps(w, 60);
    assert_near(plumb_body_position(w, body).y, 0.5, 0.01);
    plumb_vec2 ell[] = { { 0, 0 }, { 2, 0 }, { 2, 1 }, { 1, 1 }, { 1, 2 }, { 0, 2 } };
    plumb_shape_desc outline = { .kind = PLUMB_OUTLINE, .points = ell, .count = 6 };
    assert_int_equal(plumb_shape_set_geometry(w, disc, &outline), PLUMB_OK);
    assert_near(plumb_body_mass(w, body), 9, ROUNDED(1e-4));
    steps(w, 30);
    plumb_shape_destroy(w, disc);
    assert_int_equal(plumb_body_shapes(w, body, NULL, 0), 0);
    assert_int_equal(plumb_shape_set_geometry(w, disc, &BOX), PLUMB_E_HANDLE);
    assert_int_equal(plumb_shape_set_geometry(w, floor, NULL), PLUMB_E_NULL);
    assert_int_equal(plumb_shape_set_geometry(
                         w, floor, &(plumb_shape_desc){ .kind = PLUMB_CIRCLE, .radius = -1 }),
                     PLUMB_E_RANGE);
    assert_string_equal(plumb_world_error(w).message,
                        "plumb_shape_set_geometry: radius is -1; it must be 0.0001 to 1e+07");
    plumb_world_destroy(w);
}

static void own_density_of_a_shape(void **state)
{
    (void)state;
    plumb_world *w = flat_world((plumb_world_desc){ 0 });
    plumb_material lead = plumb_material_create(w, &(plumb_material_desc){ .density = 11 });
    plumb_body b = plumb_body_create(w, &(plumb_body_desc){ 0 });
    plumb_shape_desc d = BOX;
    d.material = lead;
    d.center = plumb_v2(1, 0);
    plumb_shape s = plumb_shape_create(w, b, &d);
    assert_near(plumb_shape_density(w, s), 11, 0);
    assert_int_equal(plumb_shape_set_density(w, s, 4), PLUMB_OK);
    assert_near(plumb_body_mass(w, b), 4, ROUNDED(1e-6));
    plumb_mass_properties m = plumb_shape_mass(w, s);
    assert_near(m.mass, 4, ROUNDED(1e-6));
    assert_vec_near(m.center, 1, 0, 0);
    assert_near(m.inertia, 4 / 6.0, ROUNDED(1e-6));
    assert_int_equal(plumb_shape_set_density(w, s, 0), PLUMB_OK);
    assert_near(plumb_body_mass(w, b), 11, ROUNDED(1e-5));
    assert_int_equal(plumb_shape_set_density(w, s, R(1e37)), PLUMB_E_RANGE);
    assert_near(plumb_shape_density(w, s), 11, 0);
    assert_near(plumb_body_mass(w, b), 11, ROUNDED(1e-5));
    assert_int_equal(plumb_shape_set_density(w, s, -1), PLUMB_E_RANGE);
    assert_string_equal(plumb_world_error(w).message,
                        "plumb_shape_set_density: density is -1; it must be at least 0");
    assert_int_equal(plumb_shape_set_density(w, NO_SHAPE, 1), PLUMB_E_HANDLE);
    assert_near(plumb_shape_density(w, NO_SHAPE), 0, 0);
    assert_near(plumb_shape_mass(w, NO_SHAPE).mass, 0, 0);
    plumb_world_destroy(w);
}

// The same of a shape of several pieces, made anew in the slots that it had: one touch ends, another
// begins.
static void a_shape_of_several_pieces_made_anew(void **state)
{
    (void)state;
    static const plumb_vec2 ell[] = { { 0, 0 }, { 2, 0 }, { 2, 1 }, { 1, 1 }, { 1, 2 }, { 0, 2 } };
    const plumb_shape_desc desc = { .kind = PLUMB_OUTLINE, .points = ell, .count = 6 };
    plumb_world *w = flat_world((plumb_world_desc){ 0 });
    plumb_shape floor = add_floor(w, NO_MATERIAL), old = PLUMB_NULL_INIT;
    plumb_body body = plumb_body_create(w, &(plumb_body_desc){ .no_sleep = true });
    for (int i = 0; i < 3; ++i) {
        if (i > 0) {
            plumb_shape_destroy(w, old);
        }
        plumb_shape shape = plumb_shape_create(w, body, &desc);
        ends e = step(w);
        int begins;
        const plumb_contact_begin *begun = plumb_world_begin_events(w, &begins);
        assert_int_equal(begins, 1);
        assert_true(plumb_same(begun[0].shape_a, shape) || plumb_same(begun[0].shape_b, shape));
        assert_int_equal(e.count, i > 0);
        assert_true(i == 0 || names(&e, floor, old));
        assert_true(i == 0 || old.entity.index == shape.entity.index);
        old = shape;
    }
    plumb_world_destroy(w);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_destroyed_body_ends_its_touches),
        cmocka_unit_test(a_shape_of_several_pieces_made_anew),
        cmocka_unit_test(the_last_touch_ends_too),
        cmocka_unit_test(shapes_of_several_pieces_end_once),
        cmocka_unit_test(slots_taken_anew_do_not_confuse),
        cmocka_unit_test(a_new_form_touches_anew),
        cmocka_unit_test(own_density_of_a_shape),
    };
    return cmocka_run_group_tests_name("gone", tests, NULL, NULL);
}
