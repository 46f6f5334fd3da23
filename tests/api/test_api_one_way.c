// test_api_one_way.c - the one-way property of shapes through the API: what is set is read, wrong
// values are refused, the pass is scheduled only where it is wanted.
#include "world_fixture.h"

#include <stdio.h>

static void property_is_kept(void **state)
{
    fixture *f = *state;
    plumb_shape_desc desc = { .kind = PLUMB_BOX,
                              .half = { 1, 1 },
                              .one_way = { { 0, 4 }, R(0.5) } };
    plumb_shape shape = plumb_shape_create(f->world, f->fixed, &desc);
    plumb_one_way o = plumb_shape_one_way(f->world, shape);
    assert_true(o.direction.x == 0 && o.direction.y == 1 && o.angle == R(0.5));
    o = plumb_shape_one_way(f->world, f->box);
    assert_true(o.direction.x == 0 && o.direction.y == 0 && o.angle == 0);
    assert_int_equal(plumb_shape_set_one_way(f->world, shape, (plumb_one_way){ { -3, 0 }, 0 }),
                     PLUMB_OK);
    o = plumb_shape_one_way(f->world, shape);
    assert_true(o.direction.x == -1 && o.direction.y == 0 && o.angle == 0);
    plumb_shape_destroy(f->world, shape);
    o = plumb_shape_one_way(f->world, shape);
    assert_true(o.direction.x == 0);
}

static bool scheduled(plumb_world *world)
{
    plumb_pass_info rows[128];
    int count = plumb_world_schedule(world, rows, 128);
    for (int i = 0; i < count; ++i) {
        for (int k = 0; strcmp(rows[i].name, "narrow phase") == 0 && k < rows[i].variant_count;
             ++k) {
            if (strcmp(rows[i].variants[k], "one-way") == 0) {
                return true;
            }
        }
    }
    return false;
}

static void costs_nothing_where_unused(void **state)
{
    fixture *f = *state;
    assert_false(scheduled(f->world));
    plumb_one_way up = { { 0, 1 }, 0 };
    assert_int_equal(plumb_shape_set_one_way(f->world, f->box, up), PLUMB_OK);
    assert_true(scheduled(f->world));
    assert_int_equal(plumb_shape_set_one_way(f->world, f->box, (plumb_one_way){ 0 }), PLUMB_OK);
    assert_false(scheduled(f->world));
    plumb_shape_set_one_way(f->world, f->box, up);
    plumb_shape_destroy(f->world, f->box);
    assert_false(scheduled(f->world));
}

// Every piece of a shape has it, and a slot that is taken anew has not.
static void pieces_and_slots(void **state)
{
    fixture *f = *state;
    const plumb_vec2 ell[] = { { 0, 0 }, { 2, 0 }, { 2, 1 }, { 1, 1 }, { 1, 2 }, { 0, 2 } };
    plumb_shape_desc desc = {
        .kind = PLUMB_OUTLINE, .points = ell, .count = 6, .one_way = { { 0, 1 }, 0 }
    };
    plumb_shape shape = plumb_shape_create(f->world, f->fixed, &desc);
    assert_true(scheduled(f->world));
    plumb_shape_destroy(f->world, shape);
    assert_false(scheduled(f->world));
    desc.one_way.direction.y = 0;
    plumb_shape_create(f->world, f->fixed, &desc);
    assert_false(scheduled(f->world));
}

// A shape that gets another form lets pass as before, whatever the descriptor says; so do parts and what is merged.
static void another_form_keeps_it(void **state)
{
    fixture *f = *state;
    const plumb_vec2 points[] = { { -2, 0 }, { 2, 0 }, { 2, 1 }, { -2, 1 } };
    const plumb_shape_desc forms[] = {
        { .kind = PLUMB_BOX, .half = { 2, 1 } },
        { .kind = PLUMB_CIRCLE, .radius = 2, .one_way = { { 1, 0 }, 0 } },
        { .kind = PLUMB_CHAIN, .points = points, .count = 4 },
        { .kind = PLUMB_OUTLINE, .points = points, .count = 4, .one_way = { { 1, 0 }, 1 } },
        { .kind = PLUMB_SEGMENT, .points = points, .count = 2 },
        { .kind = PLUMB_POLYGON, .points = points, .count = 4 },
        { .kind = PLUMB_CAPSULE, .points = points, .count = 2, .radius = 1 },
    };
    plumb_body body = plumb_body_create(f->world, &(plumb_body_desc){ .type = PLUMB_STATIC });
    plumb_shape_desc desc = forms[0];
    desc.one_way = (plumb_one_way){ { 0, 1 }, R(0.75) };
    plumb_shape shape = plumb_shape_create(f->world, body, &desc);
    for (size_t i = 0; i < 3 * sizeof forms / sizeof forms[0]; ++i) {
        desc = forms[3 * i % (sizeof forms / sizeof forms[0])];
        assert_int_equal(plumb_shape_set_geometry(f->world, shape, &desc), PLUMB_OK);
        plumb_one_way o = plumb_shape_one_way(f->world, shape);
        assert_true(o.direction.x == 0 && o.direction.y == 1 && o.angle == R(0.75));
    }
    assert_int_equal(plumb_shape_set_one_way(f->world, shape, (plumb_one_way){ 0 }), PLUMB_OK);
    assert_int_equal(plumb_shape_set_geometry(f->world, shape, &forms[1]), PLUMB_OK);
    assert_true(plumb_shape_one_way(f->world, shape).direction.x == 0);
}

// Rays and casts that start inside pass, at the largest angle too, where they would be held from beside.
static void what_starts_inside_passes(void **state)
{
    fixture *f = *state;
    const plumb_query_filter filter = { .one_way = true };
    plumb_body body = plumb_body_create(
        f->world, &(plumb_body_desc){ .type = PLUMB_STATIC, .position = { 50, 0 } });
    plumb_shape shape = plumb_shape_create(
        f->world, body, &(plumb_shape_desc){ .kind = PLUMB_BOX, .half = { 2, 1 } });
    plumb_convex ball;
    assert_int_equal(plumb_convex_circle((plumb_vec2){ 0, 0 }, R(0.25), &ball), PLUMB_OK);
    for (int i = 0; i <= 8; ++i) {
        const plumb_one_way o = { { 0, 1 }, i == 8 ? R(1.5707964) : R(0.1 + 0.2 * i) };
        assert_int_equal(plumb_shape_set_one_way(f->world, shape, o), PLUMB_OK);
        for (int k = 0; k < 12; ++k) {
            const plumb_vec2 way = plumb_vec2_polar(9, R(0.5 * k)), from = { R(50.5), R(0.125) };
            const plumb_cast cast = { &ball, { from, { 1, 0 } }, way };
            plumb_ray_hit hit;
            assert_true(plumb_world_ray(f->world, from, plumb_vec2_add(from, way), NULL, &hit));
            assert_false(plumb_world_ray_any(f->world, from, plumb_vec2_add(from, way), &filter));
            assert_false(plumb_world_cast_any(f->world, &cast, &filter));
        }
    }
}

static plumb_result make(fixture *f, plumb_one_way one_way)
{
    plumb_shape_desc desc = { .kind = PLUMB_CIRCLE, .radius = 1, .one_way = one_way };
    return made(f->world, plumb_shape_create(f->world, f->fixed, &desc));
}

static void wrong_values_are_refused(void **state)
{
    fixture *f = *state;
    const struct {
        plumb_one_way value;
        plumb_result code;
        const char *message;
    } cases[] = {
        { { { (plumb_real)NAN, 0 }, 0 },
          PLUMB_E_NOT_FINITE,
          "one_way.direction is (nan, 0); it must be finite" },
        { { { 0, 1 }, -1 }, PLUMB_E_RANGE, "one_way.angle is -1; it must be 0 to 1.5708" },
        { { { 0, 1 }, 2 }, PLUMB_E_RANGE, "one_way.angle is 2; it must be 0 to 1.5708" },
        { { { 0, 1 }, (plumb_real)NAN },
          PLUMB_E_NOT_FINITE,
          "one_way.angle is nan; it must be finite" },
        { { { 0, 0 }, 1 },
          PLUMB_E_RANGE,
          "one_way.angle is 1; it must be 0 without one_way.direction" },
    };
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; ++i) {
        char text[200];
        snprintf(text, sizeof text, "plumb_shape_create: %s", cases[i].message);
        uint64_t before = digest_world(f->world);
        int errors = f->errors;
        check_refused(f, make(f, cases[i].value), before, errors, cases[i].code, text);
        snprintf(text, sizeof text, "plumb_shape_set_one_way: %s", cases[i].message);
        errors = f->errors;
        plumb_result r = plumb_shape_set_one_way(f->world, f->box, cases[i].value);
        check_refused(f, r, before, errors, cases[i].code, text);
    }
}

static void wrong_handles_are_refused(void **state)
{
    fixture *f = *state;
    const plumb_one_way up = { { 0, 1 }, 0 };
    REFUSED(E_HANDLE, "plumb_shape_set_one_way: shape is stale (0:1); it must be a live shape",
            plumb_shape_set_one_way(f->world, (plumb_shape){ f->stale.entity }, up));
    REFUSED(E_HANDLE, "plumb_body_drop_through: body is stale (0:1); it must be a live body",
            plumb_body_drop_through(f->world, f->stale));
    REFUSED(E_STATE, "plumb_body_drop_through: body is static; it must be dynamic",
            plumb_body_drop_through(f->world, f->fixed));
    REFUSED(E_STATE, "plumb_body_drop_through: body is kinematic; it must be dynamic",
            plumb_body_drop_through(f->world, f->kinematic));
    assert_int_equal(plumb_shape_set_one_way(NULL, f->box, up), PLUMB_E_NULL);
    assert_int_equal(plumb_body_drop_through(NULL, f->dynamic), PLUMB_E_NULL);
}

// A request is for the next step; without a one-way shape it is for none.
static void requests_do_not_outlive_a_step(void **state)
{
    fixture *f = *state;
    assert_int_equal(plumb_body_drop_through(f->world, f->dynamic), PLUMB_OK);
    plumb_shape ground = plumb_shape_create(f->world, f->fixed,
                                            &(plumb_shape_desc){ .kind = PLUMB_BOX,
                                                                 .half = { 4, R(0.5) },
                                                                 .center = { 0, R(1.5) },
                                                                 .one_way = { { 0, 1 }, 0 } });
    assert_false(plumb_is_null(ground));
    assert_int_equal(plumb_body_drop_through(f->world, f->dynamic), PLUMB_OK); // still in the air
    for (int i = 0; i < 180; ++i) {
        plumb_world_step(f->world, R(1.0 / 60));
    }
    assert_near(plumb_body_position(f->world, f->dynamic).y, 3, 0.01);
    // Nor when the body takes no part in that step, or the last one-way shape has gone by then.
    assert_int_equal(plumb_body_drop_through(f->world, f->dynamic), PLUMB_OK);
    plumb_body_set_enabled(f->world, f->dynamic, false);
    assert_int_equal(plumb_body_drop_through(f->world, f->dynamic), PLUMB_OK);
    plumb_world_step(f->world, R(1.0 / 60));
    plumb_body_set_enabled(f->world, f->dynamic, true);
    for (int i = 0; i < 60; ++i) {
        plumb_world_step(f->world, R(1.0 / 60));
    }
    assert_near(plumb_body_position(f->world, f->dynamic).y, 3, 0.01);
    assert_int_equal(plumb_body_drop_through(f->world, f->dynamic), PLUMB_OK);
    plumb_shape_set_one_way(f->world, ground, (plumb_one_way){ 0 });
    plumb_world_step(f->world, R(1.0 / 60));
    plumb_shape_set_one_way(f->world, ground, (plumb_one_way){ { 0, 1 }, 0 });
    for (int i = 0; i < 60; ++i) {
        plumb_world_step(f->world, R(1.0 / 60));
    }
    assert_near(plumb_body_position(f->world, f->dynamic).y, 3, 0.01);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        API_TEST(property_is_kept),          API_TEST(costs_nothing_where_unused),
        API_TEST(pieces_and_slots),          API_TEST(wrong_values_are_refused),
        API_TEST(wrong_handles_are_refused), API_TEST(requests_do_not_outlive_a_step),
        API_TEST(another_form_keeps_it),     API_TEST(what_starts_inside_passes),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
