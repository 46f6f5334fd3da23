// test_api_filter.c - which shapes meet: filters, excluded pairs, sensors; what they refuse.
#include "contact_fixture.h"

//---- filters -------------------------------------------------------------------------------------

static void the_rule_of_filters(void **state)
{
    (void)state;
    const plumb_filter all = { 0 };
    const plumb_filter one = { .category = 2, .mask = 1 };
    const plumb_filter two = { .category = UINT64_C(1) << 63, .mask = 2 };
    const plumb_filter none = { .nothing = true };
    assert_true(plumb_filters_meet(all, all));
    assert_true(plumb_filters_meet(all, one));
    assert_false(plumb_filters_meet(one, one));
    assert_false(plumb_filters_meet(one, two)); // one side is not enough
    assert_false(plumb_filters_meet(all, two));
    assert_false(plumb_filters_meet(none, all));
    plumb_filter a = { .group = 3, .nothing = true }, b = { .group = 3 };
    assert_true(plumb_filters_meet(a, b));
    a.group = b.group = -3;
    a.nothing = false;
    assert_false(plumb_filters_meet(a, b));
    b.group = -4;
    assert_true(plumb_filters_meet(a, b));
}

// A disc over a floor falls through it or not.
static bool passes(plumb_filter floor, plumb_filter disc)
{
    plumb_world *w = flat_world((plumb_world_desc){ 0 });
    plumb_shape ground = add_floor(w, NO_MATERIAL);
    assert_int_equal(plumb_shape_set_filter(w, ground, floor), PLUMB_OK);
    plumb_body body = add_disc(w, 0, 0.6, (plumb_shape_desc){ .filter = disc }, NULL);
    steps(w, 64);
    bool through = plumb_body_position(w, body).y < -1;
    plumb_world_destroy(w);
    return through;
}

static void filtered_shapes_pass_through_each_other(void **state)
{
    (void)state;
    const plumb_filter all = { 0 };
    assert_false(passes(all, all));
    assert_false(passes(all, (plumb_filter){ .category = 4 }));
    assert_true(passes((plumb_filter){ .mask = ~UINT64_C(4) }, (plumb_filter){ .category = 4 }));
    assert_true(passes(all, (plumb_filter){ .nothing = true }));
    assert_true(passes((plumb_filter){ .group = -1 }, (plumb_filter){ .group = -1 }));
    assert_false(
        passes((plumb_filter){ .group = 1 }, (plumb_filter){ .group = 1, .nothing = true }));
}

// Pair finding passes over whole crowds whose filters keep them apart: the pairs that are left are those
// of the rule. Discs on one spot, the last of them of the floor's body type.
static void many_are_kept_apart_by_the_rule(void **state)
{
    (void)state;
    enum { DISCS = 5 };
    const plumb_filter palettes[][DISCS] = {
        { { .group = -1 }, { .group = -1 }, { .group = -1 }, { .group = -1 }, { .group = -1 } },
        { { .group = -1 }, { .group = -1 }, { .group = -1 }, { .group = -1 }, { .group = -2 } },
        { { .group = -1 }, { .group = -2 }, { .group = -1 }, { .group = -2 }, { .group = 0 } },
        { { 2, 1, 0, false }, { 2, 1, 0, false }, { 4, 1, 0, false }, { 2, 8, 0, false }, { 0 } },
        { { 2, 1, 0, false },
          { 2, 1, 0, false },
          { 4, 1, 0, false },
          { 2, 8, 0, false },
          { 2, 1, 0, false } },
        { { 2, 1, 3, false }, { 2, 1, 0, false }, { 4, 1, 3, false }, { 2, 8, 0, false }, { 0 } },
        { { 2, 1, 0, false },
          { 2, 1, 0, false },
          { 4, 1, 3, false },
          { 2, 8, 0, false },
          { 2, 1, 3, false } },
        { { .nothing = true }, { .nothing = true }, { .nothing = true }, { 0 }, { 0 } },
        { { 0 }, { 0 }, { 2, 1, 0, false }, { 0 }, { 2, 1, 0, false } },
    };
    for (size_t k = 0; k < sizeof palettes / sizeof palettes[0]; ++k) {
        plumb_world *w = flat_world((plumb_world_desc){ .zero_gravity = true });
        plumb_shape shapes[DISCS];
        uint32_t expected = 0;
        for (int i = 0; i < DISCS; ++i) {
            plumb_body body = plumb_body_create(
                w, &(plumb_body_desc){ .type = i == DISCS - 1 ? PLUMB_STATIC : PLUMB_DYNAMIC });
            shapes[i] = plumb_shape_create(
                w, body,
                &(plumb_shape_desc){ .kind = PLUMB_CIRCLE, .radius = 1, .filter = palettes[k][i] });
            assert_false(plumb_is_null(shapes[i]));
            for (int j = 0; j < i; ++j) {
                expected += plumb_filters_meet(palettes[k][i], palettes[k][j]);
            }
        }
        steps(w, 1);
        assert_int_equal(plumb_world_stats(w).pair_count, expected);
        plumb_world_destroy(w);
    }
}

static void a_changed_filter_ends_the_touch(void **state)
{
    (void)state;
    plumb_world *w = flat_world((plumb_world_desc){ 0 });
    add_floor(w, NO_MATERIAL);
    plumb_shape shape;
    plumb_body body = add_disc(w, 0, 0.5, (plumb_shape_desc){ 0 }, &shape);
    steps(w, 10);
    assert_int_equal(plumb_world_contacts(w, NULL, 0), 1);
    plumb_filter f = plumb_shape_filter(w, shape);
    assert_true(f.category == 1 && f.mask == UINT64_MAX && f.group == 0 && !f.nothing);
    plumb_shape_set_filter(w, shape, (plumb_filter){ .category = 6, .nothing = true });
    f = plumb_shape_filter(w, shape);
    assert_true(f.category == 6 && f.mask == 0 && f.nothing);
    steps(w, 1);
    int ends;
    plumb_world_end_events(w, &ends);
    assert_int_equal(ends, 1);
    steps(w, 40);
    assert_true(plumb_body_position(w, body).y < 0);
    plumb_world_destroy(w);
}

static void excluded_bodies_pass_through_each_other(void **state)
{
    (void)state;
    plumb_world *w = flat_world((plumb_world_desc){ .zero_gravity = true });
    plumb_body a = add_disc(w, 0, 0, (plumb_shape_desc){ 0 }, NULL);
    plumb_body b = add_disc(w, 0.5, 0, (plumb_shape_desc){ 0 }, NULL);
    plumb_body c = add_disc(w, 0, 0.5, (plumb_shape_desc){ 0 }, NULL);
    assert_int_equal(plumb_world_exclude_pair(w, b, a, true), PLUMB_OK);
    assert_int_equal(plumb_world_exclude_pair(w, a, b, true), PLUMB_OK);
    assert_true(plumb_world_is_excluded(w, a, b) && plumb_world_is_excluded(w, b, a));
    assert_false(plumb_world_is_excluded(w, a, c));
    steps(w, 1);
    assert_int_equal(plumb_world_stats(w).pair_count, 2);
    assert_int_equal(plumb_world_exclude_pair(w, a, b, false), PLUMB_OK);
    assert_int_equal(plumb_world_exclude_pair(w, a, c, true), PLUMB_OK);
    steps(w, 1);
    assert_int_equal(plumb_world_stats(w).pair_count, 2);
    plumb_body_destroy(w, c);
    for (int i = 0; i < 8; ++i) { // one of them takes its slot, and nothing else of it
        plumb_body e = plumb_body_create(w, &(plumb_body_desc){ .position = { 50, 0 } });
        plumb_world_exclude_pair(w, e, b, true);
        assert_false(plumb_world_is_excluded(w, a, e));
    }
    plumb_body d = add_disc(w, 0, 0.5, (plumb_shape_desc){ 0 }, NULL);
    assert_false(plumb_world_is_excluded(w, a, d));
    assert_false(plumb_world_is_excluded(w, a, c));
    plumb_world_exclude_pair(w, d, b, true); // that is all that it is kept apart from
    assert_false(plumb_world_is_excluded(w, a, d));
    steps(w, 1);
    assert_int_equal(plumb_world_stats(w).pair_count, 2);
    plumb_world_destroy(w);
}

static void queries_ask_the_filter(void **state)
{
    (void)state;
    plumb_world *w = flat_world((plumb_world_desc){ 0 });
    plumb_filter red = { .category = 2, .mask = 8 };
    plumb_shape s, sensor;
    add_disc(w, 0, 0, (plumb_shape_desc){ .filter = red }, &s);
    add_disc(w, 5, 0, (plumb_shape_desc){ .sensor = true }, &sensor);
    const struct {
        plumb_query_filter filter;
        int at_disc, at_sensor;
    } rows[] = {
        { { .sensors = false }, 1, 0 },
        { { .sensors = true }, 1, 1 },
        { { .mask = 1 }, 0, 0 },
        { { .mask = 1, .sensors = true }, 0, 1 },
        { { .mask = 2 }, 1, 0 },
        { { .category = 8 }, 1, 0 },
        { { .category = 4, .sensors = true }, 0, 1 },
    };
    for (size_t i = 0; i < sizeof rows / sizeof rows[0]; ++i) {
        plumb_ray_hit hit;
        const plumb_query_filter *q = &rows[i].filter;
        assert_int_equal(plumb_world_overlap_point(w, plumb_v2(0, 0), q, NULL, 0), rows[i].at_disc);
        assert_int_equal(plumb_world_overlap_point(w, plumb_v2(5, 0), q, NULL, 0),
                         rows[i].at_sensor);
        assert_int_equal(plumb_world_ray(w, plumb_v2(5, 3), plumb_v2(5, -3), q, &hit),
                         rows[i].at_sensor);
    }
    plumb_world_destroy(w);
}

//---- sensors -------------------------------------------------------------------------------------

static int sensor_begins(const plumb_world *w)
{
    int count;
    plumb_world_sensor_begin_events(w, &count);
    return count;
}

static int sensor_ends(const plumb_world *w)
{
    int count;
    plumb_world_sensor_end_events(w, &count);
    return count;
}

static void a_ball_falls_through_a_static_sensor(void **state)
{
    (void)state;
    plumb_world *w = flat_world((plumb_world_desc){ 0 });
    plumb_body gate = plumb_body_create(w, &(plumb_body_desc){ .type = PLUMB_STATIC });
    plumb_shape sensor = plumb_shape_create(
        w, gate, &(plumb_shape_desc){ .kind = PLUMB_BOX, .half = { 1, 1 }, .sensor = true });
    plumb_shape ball;
    plumb_body body = add_disc(w, 0, 3, (plumb_shape_desc){ 0 }, &ball);
    int begins = 0, ends = 0;
    for (int i = 0; i < 100; ++i) {
        steps(w, 1);
        plumb_real y = plumb_body_position(w, body).y;
        plumb_shape seen = PLUMB_NULL_INIT;
        bool inside = y < R(1.5) && y > R(-1.5);
        assert_int_equal(plumb_shape_overlaps(w, sensor, &seen, 1), inside);
        assert_true(!inside || plumb_same(seen, ball));
        int count;
        const plumb_sensor_event *e = plumb_world_sensor_begin_events(w, &count);
        if (count > 0) {
            assert_true(plumb_same(e->sensor, sensor) && plumb_same(e->shape, ball));
            assert_true(plumb_same(e->sensor_body, gate) && plumb_same(e->body, body));
        }
        begins += count;
        ends += sensor_ends(w);
    }
    assert_int_equal(begins, 1);
    assert_int_equal(ends, 1);
    // No force: it fell freely. 100 steps of 1/64 s.
    double t = 100.0 / 64;
    assert_near(plumb_body_position(w, body).y, 3 - 9.81 * t * t / 2, ROUNDED(1e-3));
    assert_int_equal(plumb_world_contacts(w, NULL, 0), 0);
    plumb_world_destroy(w);
}

static void the_test_is_exact(void **state)
{
    (void)state;
    plumb_world *w = flat_world((plumb_world_desc){ .zero_gravity = true });
    plumb_body gate = plumb_body_create(w, &(plumb_body_desc){ .type = PLUMB_KINEMATIC });
    plumb_shape sensor = plumb_shape_create(
        w, gate, &(plumb_shape_desc){ .kind = PLUMB_CIRCLE, .radius = 1, .sensor = true });
    add_disc(w, 1.2, 1.2, (plumb_shape_desc){ 0 }, NULL); // boxes overlap, circles do not
    add_disc(w, 1.0, -1.0, (plumb_shape_desc){ 0 }, NULL);
    steps(w, 1);
    assert_int_equal(plumb_shape_overlaps(w, sensor, NULL, 0), 1);
    plumb_world_destroy(w);
}

static bool is_scheduled(const plumb_world *w, const char *name)
{
    plumb_pass_info rows[128];
    int count = plumb_world_schedule(w, rows, 128);
    for (int i = 0; i < count; ++i) {
        if (strcmp(rows[i].name, name) == 0) {
            return rows[i].scheduled;
        }
    }
    fail_msg("no pass is named %s", name);
    return false;
}

// No dynamic body at all: a kinematic sensor moves over static shapes, another sensor, its own
// body.
static void moving_sensors_see_static_shapes_and_sensors(void **state)
{
    (void)state;
    plumb_world *w = flat_world((plumb_world_desc){ 0 });
    const plumb_vec2 line[] = { { -1, 0 }, { 0, 0 }, { 1, 0 } };
    plumb_body fixed = plumb_body_create(w, &(plumb_body_desc){ .type = PLUMB_STATIC });
    plumb_shape chain = plumb_shape_create(
        w, fixed, &(plumb_shape_desc){ .kind = PLUMB_CHAIN, .points = line, .count = 3 });
    plumb_shape other = plumb_shape_create(
        w, fixed, &(plumb_shape_desc){ .kind = PLUMB_CIRCLE, .radius = R(0.5), .sensor = true });
    plumb_body eye = plumb_body_create(
        w,
        &(plumb_body_desc){ .type = PLUMB_KINEMATIC, .position = { -5, 0 }, .velocity = { 4, 0 } });
    plumb_shape_desc desc = { .kind = PLUMB_CIRCLE, .radius = R(0.5), .sensor = true };
    plumb_shape sensor = plumb_shape_create(w, eye, &desc);
    desc.sensor = false;
    plumb_shape_create(w, eye, &desc);
    int begins = 0;
    for (int i = 0; i < 80; ++i) { // to x = 0
        steps(w, 1);
        begins += sensor_begins(w);
    }
    plumb_shape seen[4];
    assert_int_equal(plumb_shape_overlaps(w, sensor, seen, 4), 2);
    assert_true(plumb_same(seen[0], chain) && plumb_same(seen[1], other));
    assert_int_equal(plumb_shape_overlaps(w, other, seen, 4), 2); // sensor and shape of the eye
    assert_int_equal(begins, 4);
    assert_true(is_scheduled(w, "sensors"));
    // Both links of the chain overlap; it is one shape, and goes once.
    plumb_shape_destroy(w, chain);
    assert_int_equal(plumb_shape_overlaps(w, sensor, seen, 4), 1);
    steps(w, 1);
    assert_int_equal(sensor_ends(w), 1);
    plumb_shape_destroy(w, sensor);
    plumb_body_destroy(w, fixed);
    steps(w, 1);
    assert_int_equal(sensor_ends(w), 3);
    steps(w, 1);
    assert_int_equal(sensor_ends(w), 0);
    add_disc(w, 0, 5, (plumb_shape_desc){ 0 }, NULL);
    assert_false(is_scheduled(w, "sensors")); // none is left: nothing to pay
    plumb_world_destroy(w);
}

static void a_sensor_obeys_its_filter_and_has_no_mass(void **state)
{
    (void)state;
    plumb_world *w = flat_world((plumb_world_desc){ .zero_gravity = true });
    plumb_body a = add_disc(w, 0, 0, (plumb_shape_desc){ 0 }, NULL);
    plumb_real mass = plumb_body_mass(w, a);
    plumb_shape sensor = plumb_shape_create(w, a,
                                            &(plumb_shape_desc){ .kind = PLUMB_CIRCLE,
                                                                 .radius = 2,
                                                                 .density = 50,
                                                                 .filter = { .mask = 4 },
                                                                 .sensor = true });
    assert_near(plumb_body_mass(w, a), mass, 0);
    plumb_body_reset_mass(w, a);
    assert_near(plumb_body_mass(w, a), mass, 0);
    add_disc(w, 2, 0, (plumb_shape_desc){ 0 }, NULL);
    add_disc(w, -2, 0, (plumb_shape_desc){ .filter = { .category = 4 } }, NULL);
    steps(w, 1);
    assert_int_equal(plumb_shape_overlaps(w, sensor, NULL, 0), 1);
    assert_true(plumb_shape_is_sensor(w, sensor));
    assert_int_equal(plumb_shape_set_sensor(w, sensor, false), PLUMB_OK);
    assert_near(plumb_body_mass(w, a), mass + 50 * 4 * R(3.14159265), 1e-2);
    steps(w, 1);
    assert_int_equal(sensor_ends(w), 1);
    assert_int_equal(plumb_world_stats(w).contact_count, 1);
    plumb_world_destroy(w);
}

//---- refusals ------------------------------------------------------------------------------------

static plumb_result shape_code(fixture *f, plumb_shape_desc desc)
{
    desc.kind = PLUMB_CIRCLE;
    desc.radius = 1;
    return made(W, plumb_shape_create(W, f->dynamic, &desc));
}

static plumb_result overlaps_code(const plumb_world *w, int count)
{
    return count < 0 ? plumb_world_error(w).code : PLUMB_OK;
}

static void wrong_filters_and_sensors_are_refused(void **state)
{
    fixture *f = *state;
    plumb_filter both = { .mask = 18, .nothing = true };
    REFUSED(E_RANGE, "plumb_shape_create: filter.mask is 0x12; it must be 0 with nothing",
            shape_code(f, (plumb_shape_desc){ .filter = both }));
    REFUSED(E_RANGE, "plumb_shape_set_filter: filter.mask is 0x12; it must be 0 with nothing",
            plumb_shape_set_filter(W, f->box, both));
    REFUSED(E_HANDLE, "plumb_shape_set_filter: shape is null; it must be a live shape",
            plumb_shape_set_filter(W, NO_SHAPE, (plumb_filter){ 0 }));
    REFUSED(E_HANDLE, "plumb_shape_set_sensor: shape is a body; it must be a live shape",
            plumb_shape_set_sensor(W, (plumb_shape){ f->dynamic.entity }, true));
    REFUSED(E_HANDLE, "plumb_world_exclude_pair: a is stale (0:1); it must be a live body",
            plumb_world_exclude_pair(W, f->stale, f->fixed, true));
    REFUSED(E_HANDLE, "plumb_world_exclude_pair: b is a shape; it must be a live body",
            plumb_world_exclude_pair(W, f->fixed, (plumb_body){ f->box.entity }, true));
    REFUSED(E_RANGE, "plumb_world_exclude_pair: b is the same body as a; it must be another",
            plumb_world_exclude_pair(W, f->fixed, f->fixed, true));
    REFUSED(E_STATE, "plumb_shape_overlaps: shape is no sensor; it must be one",
            overlaps_code(W, plumb_shape_overlaps(W, f->box, NULL, 0)));
    REFUSED(E_HANDLE, "plumb_shape_overlaps: shape is null; it must be a live shape",
            overlaps_code(W, plumb_shape_overlaps(W, NO_SHAPE, NULL, 0)));
    plumb_shape_set_sensor(W, f->box, true);
    REFUSED(E_RANGE, "plumb_shape_overlaps: capacity is -1; it must be at least 0",
            overlaps_code(W, plumb_shape_overlaps(W, f->box, NULL, -1)));
    REFUSED(E_NULL, "plumb_shape_overlaps: shapes is null; it must be given",
            overlaps_code(W, plumb_shape_overlaps(W, f->box, NULL, 1)));
    plumb_filter none = plumb_shape_filter(W, NO_SHAPE);
    assert_true(none.category == 0 && none.mask == 0);
    assert_false(plumb_shape_is_sensor(W, NO_SHAPE) ||
                 plumb_world_is_excluded(W, NO_BODY, NO_BODY));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_rule_of_filters),
        cmocka_unit_test(filtered_shapes_pass_through_each_other),
        cmocka_unit_test(many_are_kept_apart_by_the_rule),
        cmocka_unit_test(a_changed_filter_ends_the_touch),
        cmocka_unit_test(excluded_bodies_pass_through_each_other),
        cmocka_unit_test(queries_ask_the_filter),
        cmocka_unit_test(a_ball_falls_through_a_static_sensor),
        cmocka_unit_test(the_test_is_exact),
        cmocka_unit_test(moving_sensors_see_static_shapes_and_sensors),
        cmocka_unit_test(a_sensor_obeys_its_filter_and_has_no_mass),
        API_TEST(wrong_filters_and_sensors_are_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
