// test_api_contact.c - filters, excluded pairs, sensors, surfaces, contact edits, hits: what they
// do and what they refuse.
#include "world_fixture.h"

#define DT    R(0.015625) // 1/64 s
#define NULL_ ((plumb_entity)PLUMB_NULL_INIT)
#define W     f->world

static void steps(plumb_world *w, int count)
{
    for (int i = 0; i < count; ++i) {
        assert_int_equal(plumb_world_step(w, DT), PLUMB_OK);
    }
}

static plumb_world *flat_world(plumb_world_desc desc)
{
    plumb_world *w;
    assert_int_equal(plumb_world_create(&desc, &w), PLUMB_OK);
    return w;
}

static plumb_shape add_floor(plumb_world *w, plumb_material material)
{
    plumb_body ground = plumb_body_create(w, &(plumb_body_desc){ .type = PLUMB_STATIC });
    return plumb_shape_create(
        w, ground,
        &(plumb_shape_desc){
            .kind = PLUMB_BOX, .half = { 200, 1 }, .center = { 0, -1 }, .material = material });
}

static plumb_body add_disc(plumb_world *w, double x, double y, plumb_shape_desc desc,
                           plumb_shape *shape)
{
    plumb_body body = plumb_body_create(w, &(plumb_body_desc){ .position = { R(x), R(y) } });
    desc.kind = PLUMB_CIRCLE;
    desc.radius = R(0.5);
    plumb_shape made = plumb_shape_create(w, body, &desc);
    if (shape != NULL) {
        *shape = made;
    }
    return body;
}

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
    plumb_shape ground = add_floor(w, NULL_);
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

static void a_changed_filter_ends_the_touch(void **state)
{
    (void)state;
    plumb_world *w = flat_world((plumb_world_desc){ 0 });
    add_floor(w, NULL_);
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
    plumb_body_destroy(w, c); // its slot is taken anew, without the exclusion
    plumb_body d = add_disc(w, 0, 0.5, (plumb_shape_desc){ 0 }, NULL);
    assert_false(plumb_world_is_excluded(w, a, d));
    assert_false(plumb_world_is_excluded(w, a, c));
    steps(w, 1);
    assert_int_equal(plumb_world_stats(w).pair_count, 3);
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
        plumb_shape seen = NULL_;
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
    assert_near(plumb_body_position(w, body).y, 3 - 9.81 * t * t / 2, 1e-3);
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

//---- surfaces ------------------------------------------------------------------------------------

static void a_conveyor_carries_a_box_at_its_speed(void **state)
{
    (void)state;
    for (int solver = 0; solver < 2; ++solver) {
        plumb_world *w = flat_world((plumb_world_desc){ .solver = (plumb_solver)solver });
        plumb_material belt = plumb_material_create(
            w, &(plumb_material_desc){ .friction = R(0.5), .surface_speed = 2 });
        add_floor(w, belt);
        plumb_body box = plumb_body_create(w, &(plumb_body_desc){ .position = { 0, R(0.5) } });
        plumb_shape_create(w, box,
                           &(plumb_shape_desc){ .kind = PLUMB_BOX, .half = { R(0.5), R(0.5) } });
        steps(w, 200);
        assert_near(plumb_body_velocity(w, box).x, 2, 1e-3);
        // It caught up at mu g: 2 / (sqrt(0.5 x 0.6) 9.81) s, and lost half of that way.
        double mu = sqrt(0.3), t = 200.0 / 64;
        double way = 2 * t - 2 * 2 / (2 * mu * 9.81);
        assert_near(plumb_body_position(w, box).x, way, solver == 0 ? 0.02 : 0.1);
        plumb_world_destroy(w);
    }
}

// A disc that rolls without slipping is slowed by a = f g / r / (1 + 1/2), and stops after v^2 /
// 2a.
static void a_rolling_disc_stops_where_it_should(void **state)
{
    (void)state;
    for (int solver = 0; solver < 2; ++solver) {
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
        assert_near(plumb_body_velocity(w, disc).x, 0, 1e-4);
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
    assert_near(c.friction, friction, 1e-6);
    assert_near(c.restitution, restitution, 1e-6);
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
    assert_int_equal(plumb_material_pair_set(W, f->wood, NULL_, &p), PLUMB_OK);
    assert_int_equal(plumb_material_pair_set(W, f->used, f->used, &p), PLUMB_OK);
    p.friction = 3;
    assert_int_equal(plumb_material_pair_set(W, NULL_, f->wood, &p), PLUMB_OK);
    assert_int_equal(plumb_material_pair_get(W, f->wood, NULL_, &got), PLUMB_OK);
    assert_near(got.friction, 3, 0);
    assert_near(got.rolling_resistance, 0.25, 0);
    REFUSED(E_MISSING,
            "plumb_material_pair_get: nothing is set for a and b; their materials are mixed",
            plumb_material_pair_get(W, f->wood, f->used, &got));
    // Rows move, slots are taken anew: nothing of the dead material is left, the others keep
    // theirs.
    assert_int_equal(plumb_material_destroy(W, f->wood), PLUMB_OK);
    plumb_material next = plumb_material_create(W, &(plumb_material_desc){ 0 });
    assert_int_equal(plumb_material_pair_get(W, next, NULL_, &got), PLUMB_E_MISSING);
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
    assert_int_equal(
        plumb_material_pair_set(w, NULL_, NULL_, &(plumb_material_pair){ .restitution = 1 }),
        PLUMB_OK);
    add_floor(w, NULL_);
    plumb_body disc = add_disc(w, 0, 2.5, (plumb_shape_desc){ 0 }, NULL);
    double top = 0;
    for (int i = 0; i < 128; ++i) {
        steps(w, 1);
        top = i > 64 ? fmax(top, plumb_body_position(w, disc).y) : 0;
    }
    assert_near(top, 2.5, 0.01);
    plumb_world_destroy(w);
}

//---- edits ---------------------------------------------------------------------------------------

typedef struct editor {
    plumb_contact_edit change; // what is set
    int seen;
} editor;

static void edit_all(const plumb_system_call *call)
{
    editor *e = call->context;
    int count = plumb_contact_edit_count(call->world);
    e->seen += count;
    for (int i = 0; i < count; ++i) {
        plumb_contact_edit c;
        assert_int_equal(plumb_contact_edit_get(call->world, i, &c), PLUMB_OK);
        assert_true(c.enabled && c.point_count >= 1 && plumb_shape_valid(call->world, c.shape_a));
        assert_near(c.points[0].x, 0, 20);
        c.friction = e->change.friction;
        c.restitution = e->change.restitution;
        c.surface_speed = e->change.surface_speed;
        c.rolling_resistance = e->change.rolling_resistance;
        c.enabled = e->change.enabled;
        assert_int_equal(plumb_contact_edit_set(call->world, i, &c), PLUMB_OK);
    }
}

static plumb_world *edited_world(editor *e)
{
    plumb_world *w = flat_world((plumb_world_desc){ 0 });
    plumb_system_create(
        w, &(plumb_system_desc){
               .name = "edit", .phase = PLUMB_PHASE_CONTACTS, .run = edit_all, .context = e });
    add_floor(w, NULL_);
    return w;
}

static void edits_hold_for_the_step(void **state)
{
    (void)state;
    editor e = { .change = { .friction = 1, .surface_speed = -1, .enabled = true } };
    plumb_world *w = edited_world(&e);
    plumb_body box = plumb_body_create(w, &(plumb_body_desc){ .position = { 0, R(0.5) } });
    plumb_shape_create(w, box,
                       &(plumb_shape_desc){ .kind = PLUMB_BOX, .half = { R(0.5), R(0.5) } });
    steps(w, 64);
    assert_int_equal(e.seen, 64);
    assert_near(plumb_body_velocity(w, box).x, -1, 1e-3);
    e.change.surface_speed = 0;
    e.change.friction = 0;
    steps(w, 64);
    assert_near(plumb_body_velocity(w, box).x, -1, 1e-3); // nothing brakes it
    plumb_system_enable(w, "edit", false);
    steps(w, 64);
    assert_near(plumb_body_velocity(w, box).x, 0, 1e-3); // as mixed again
    plumb_system_enable(w, "edit", true);
    e.change.enabled = false;
    steps(w, 1);
    int ends;
    plumb_world_end_events(w, &ends);
    assert_int_equal(ends, 1);
    assert_int_equal(plumb_world_contacts(w, NULL, 0), 0);
    assert_int_equal(plumb_world_stats(w).contact_count, 0);
    steps(w, 63);
    assert_near(plumb_body_position(w, box).y, 0.5 - 9.81 / 2, 0.05); // fell freely for a second
    plumb_world_destroy(w);
}

static void refuse_edits(const plumb_system_call *call)
{
    fixture *f = call->context;
    plumb_contact_edit c = { .friction = 1 };
    assert_int_equal(plumb_contact_edit_count(W), 1);
    REFUSED(E_RANGE, "plumb_contact_edit_get: i is 1; it must be 0 to 0",
            plumb_contact_edit_get(W, 1, &c));
    REFUSED(E_NULL, "plumb_contact_edit_get: edit is null; it must be given",
            plumb_contact_edit_get(W, 0, NULL));
    REFUSED(E_RANGE, "plumb_contact_edit_set: i is -1; it must be 0 to 0",
            plumb_contact_edit_set(W, -1, &c));
    c.friction = 11;
    REFUSED(E_RANGE, "plumb_contact_edit_set: friction is 11; it must be 0 to 10",
            plumb_contact_edit_set(W, 0, &c));
    c = (plumb_contact_edit){ .restitution = 2 };
    REFUSED(E_RANGE, "plumb_contact_edit_set: restitution is 2; it must be 0 to 1",
            plumb_contact_edit_set(W, 0, &c));
    c = (plumb_contact_edit){ .rolling_resistance = -1 };
    REFUSED(E_RANGE, "plumb_contact_edit_set: rolling_resistance is -1; it must be at least 0",
            plumb_contact_edit_set(W, 0, &c));
    c = (plumb_contact_edit){ .surface_speed = R(NAN) };
    REFUSED(E_NOT_FINITE, "plumb_contact_edit_set: surface_speed is nan; it must be finite",
            plumb_contact_edit_set(W, 0, &c));
}

static void edits_are_refused_out_of_their_phase(void **state)
{
    fixture *f = *state;
    plumb_contact_edit c;
    REFUSED(E_STATE,
            "plumb_contact_edit_count: no system of PLUMB_PHASE_CONTACTS runs; call it from one",
            plumb_contact_edit_count(W) == -1 ? PLUMB_E_STATE : PLUMB_OK);
    REFUSED(E_STATE,
            "plumb_contact_edit_get: no system of PLUMB_PHASE_CONTACTS runs; call it from one",
            plumb_contact_edit_get(W, 0, &c));
    REFUSED(E_STATE,
            "plumb_contact_edit_set: no system of PLUMB_PHASE_CONTACTS runs; call it from one",
            plumb_contact_edit_set(W, 0, &c));
    plumb_body_teleport(W, f->dynamic, plumb_v2(0, R(1.99)), 0);
    plumb_system_create(W, &(plumb_system_desc){ .name = "refused",
                                                 .phase = PLUMB_PHASE_CONTACTS,
                                                 .run = refuse_edits,
                                                 .context = f });
    steps(W, 1);
}

//---- events --------------------------------------------------------------------------------------

static void a_hit_tells_speed_point_and_impulse(void **state)
{
    (void)state;
    for (int solver = 0; solver < 2; ++solver) {
        plumb_world *w =
            flat_world((plumb_world_desc){ .hit_speed = 3, .solver = (plumb_solver)solver });
        plumb_shape floor = add_floor(w, NULL_), ball;
        plumb_body body = add_disc(w, 2, 2.5, (plumb_shape_desc){ 0 }, &ball);
        int hits = 0;
        for (int i = 0; i < 128; ++i) {
            steps(w, 1);
            int count;
            const plumb_contact_hit *hit = plumb_world_hit_events(w, &count);
            hits += count;
            if (count > 0) {
                double v = sqrt(2 * 9.81 * 2), m = plumb_body_mass(w, body);
                assert_true(plumb_same(hit->shape_a, floor) || plumb_same(hit->shape_b, floor));
                assert_true(plumb_same(hit->body_a, body) || plumb_same(hit->body_b, body));
                assert_near(hit->approach_speed, v, 0.2);
                assert_near(hit->impulse, m * v, 0.1 * m * v);
                assert_vec_near(hit->point, 2, 0, 0.1);
            }
        }
        assert_int_equal(hits, 1);
        // At rest, the step's impulse is the weight's.
        plumb_contact c;
        assert_int_equal(plumb_world_contacts(w, &c, 1), 1);
        double weight = 9.81 * (double)plumb_body_mass(w, body);
        assert_near(c.points[0].step_impulse, weight / 64, 0.01 * weight / 64);
        assert_int_equal(plumb_world_set_hit_speed(w, 7), PLUMB_OK);
        plumb_body_teleport(w, body, plumb_v2(2, R(2.5)), 0);
        for (int i = 0; i < 64; ++i) {
            steps(w, 1);
            assert_null(plumb_world_hit_events(w, NULL));
        }
        plumb_world_destroy(w);
    }
}

// An elastic ball: the impulse of the impact, (1 + e) m v, is part of the step's.
static void impacts_count_as_impulses(void **state)
{
    (void)state;
    plumb_world *w = flat_world((plumb_world_desc){ .hit_speed = 1, .zero_gravity = true });
    plumb_material ivory = plumb_material_create(w, &(plumb_material_desc){ .restitution = 1 });
    plumb_body a = add_disc(w, 0, 0, (plumb_shape_desc){ .material = ivory }, NULL);
    add_disc(w, 3, 0, (plumb_shape_desc){ .material = ivory }, NULL);
    plumb_body_set_velocity(w, a, plumb_v2(5, 0));
    int hits = 0;
    for (int i = 0; i < 64; ++i) {
        steps(w, 1);
        int count;
        const plumb_contact_hit *hit = plumb_world_hit_events(w, &count);
        hits += count;
        if (count > 0) {
            double m = plumb_body_mass(w, a);
            assert_near(hit->impulse, m * 5, 1e-3 * m); // 2 x reduced mass m / 2 x 5
            assert_near(hit->approach_speed, 5, 1e-3);
        }
    }
    assert_int_equal(hits, 1);
    plumb_world_destroy(w);
}

static plumb_world *chain_world(plumb_body *disc)
{
    plumb_world *w = flat_world((plumb_world_desc){ .hit_speed = R(0.5) });
    plumb_vec2 line[11];
    for (int i = 0; i < 11; ++i) {
        line[i] = plumb_v2(R(i), 0);
    }
    plumb_body ground = plumb_body_create(w, &(plumb_body_desc){ .type = PLUMB_STATIC });
    plumb_shape_create(w, ground,
                       &(plumb_shape_desc){ .kind = PLUMB_CHAIN, .points = line, .count = 11 });
    *disc = add_disc(w, 1, 0.7, (plumb_shape_desc){ 0 }, NULL);
    return w;
}

typedef struct tally {
    int begins, ends, hits, most_contacts;
} tally;

static void count_events(plumb_world *w, tally *t)
{
    int count;
    plumb_world_begin_events(w, &count);
    t->begins += count;
    plumb_world_end_events(w, &count);
    t->ends += count;
    plumb_world_hit_events(w, &count);
    t->hits += count;
    count = plumb_world_contacts(w, NULL, 0);
    t->most_contacts = count > t->most_contacts ? count : t->most_contacts;
}

// Led over ten links, pressed into them by a tenth of a millimetre, and away at the end.
static void a_chain_is_touched_once(void **state)
{
    (void)state;
    plumb_body disc;
    plumb_world *w = chain_world(&disc);
    tally t = { 0 };
    for (int i = 0; i < 220; ++i) {
        plumb_body_set_velocity(w, disc, plumb_v2(0, 0));
        plumb_body_teleport(w, disc, plumb_v2(R(0.5 + 0.05 * i), R(0.4999)), 0);
        steps(w, 1);
        count_events(w, &t);
        assert_int_equal(t.begins, 1);
    }
    assert_true(t.most_contacts == 2); // at the joints
    assert_int_equal(t.ends, 1);
    assert_int_equal(t.hits, 0);
    plumb_world_destroy(w);
}

// It falls on a joint of two links: one begin, one hit, with the impulses of both.
static void a_joint_of_a_chain_is_hit_once(void **state)
{
    (void)state;
    plumb_body disc;
    plumb_world *w = chain_world(&disc);
    double m = plumb_body_mass(w, disc), v = sqrt(2 * 9.81 * 0.2);
    tally t = { 0 };
    for (int i = 0; i < 64; ++i) {
        steps(w, 1);
        count_events(w, &t);
        const plumb_contact_hit *hit = plumb_world_hit_events(w, NULL);
        assert_true(hit == NULL || fabs((double)hit->impulse - m * v) < 0.15 * m * v);
    }
    assert_int_equal(t.begins, 1);
    assert_int_equal(t.ends, 0);
    assert_int_equal(t.hits, 1);
    assert_int_equal(t.most_contacts, 2);
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
            plumb_shape_set_filter(W, NULL_, (plumb_filter){ 0 }));
    REFUSED(E_HANDLE, "plumb_shape_set_sensor: shape is a body; it must be a live shape",
            plumb_shape_set_sensor(W, f->dynamic, true));
    REFUSED(E_HANDLE, "plumb_world_exclude_pair: a is stale (0:1); it must be a live body",
            plumb_world_exclude_pair(W, f->stale, f->fixed, true));
    REFUSED(E_HANDLE, "plumb_world_exclude_pair: b is a shape; it must be a live body",
            plumb_world_exclude_pair(W, f->fixed, f->box, true));
    REFUSED(E_RANGE, "plumb_world_exclude_pair: b is the same body as a; it must be another",
            plumb_world_exclude_pair(W, f->fixed, f->fixed, true));
    REFUSED(E_STATE, "plumb_shape_overlaps: shape is no sensor; it must be one",
            overlaps_code(W, plumb_shape_overlaps(W, f->box, NULL, 0)));
    REFUSED(E_HANDLE, "plumb_shape_overlaps: shape is null; it must be a live shape",
            overlaps_code(W, plumb_shape_overlaps(W, NULL_, NULL, 0)));
    plumb_shape_set_sensor(W, f->box, true);
    REFUSED(E_RANGE, "plumb_shape_overlaps: capacity is -1; it must be at least 0",
            overlaps_code(W, plumb_shape_overlaps(W, f->box, NULL, -1)));
    REFUSED(E_NULL, "plumb_shape_overlaps: shapes is null; it must be given",
            overlaps_code(W, plumb_shape_overlaps(W, f->box, NULL, 1)));
    plumb_filter none = plumb_shape_filter(W, NULL_);
    assert_true(none.category == 0 && none.mask == 0);
    assert_false(plumb_shape_is_sensor(W, NULL_) || plumb_world_is_excluded(W, NULL_, NULL_));
}

static void wrong_materials_and_speeds_are_refused(void **state)
{
    fixture *f = *state;
    plumb_material_desc d = { .rolling_resistance = -1 };
    REFUSED(E_RANGE, "plumb_material_create: rolling_resistance is -1; it must be at least 0",
            made(W, plumb_material_create(W, &d)));
    d = (plumb_material_desc){ .surface_speed = R(INFINITY) };
    REFUSED(E_NOT_FINITE, "plumb_material_set: surface_speed is inf; it must be finite",
            plumb_material_set(W, f->wood, &d));
    d = (plumb_material_desc){ .friction_mix = (plumb_mix)9 };
    REFUSED(E_RANGE, "plumb_material_set: friction_mix is 9; it must be a plumb_mix",
            plumb_material_set(W, f->wood, &d));
    d = (plumb_material_desc){ .restitution_mix = (plumb_mix)6 };
    REFUSED(E_RANGE, "plumb_material_set: restitution_mix is 6; it must be a plumb_mix",
            plumb_material_set(W, f->wood, &d));
    plumb_material_pair p = { .friction = 11 };
    REFUSED(E_RANGE, "plumb_material_pair_set: pair.friction is 11; it must be 0 to 10",
            plumb_material_pair_set(W, f->wood, f->used, &p));
    p = (plumb_material_pair){ .restitution = R(NAN) };
    REFUSED(E_NOT_FINITE, "plumb_material_pair_set: pair.restitution is nan; it must be finite",
            plumb_material_pair_set(W, f->wood, f->used, &p));
    p = (plumb_material_pair){ .rolling_resistance = -2 };
    REFUSED(E_RANGE,
            "plumb_material_pair_set: pair.rolling_resistance is -2; it must be at least 0",
            plumb_material_pair_set(W, f->wood, f->used, &p));
    REFUSED(E_HANDLE, "plumb_material_pair_set: a is a body; it must be a live material or null",
            plumb_material_pair_set(W, f->fixed, f->used, NULL));
    REFUSED(E_HANDLE, "plumb_material_pair_get: b is a body; it must be a live material or null",
            plumb_material_pair_get(W, f->used, f->fixed, &p));
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

static void lock_check(const plumb_system_call *call)
{
    fixture *f = call->context;
    REFUSED(
        E_LOCKED,
        "plumb_shape_set_sensor: the world is stepping (system 'locked'); call it between steps",
        plumb_shape_set_sensor(W, f->box, true));
    REFUSED(E_LOCKED,
            "plumb_world_set_hit_speed: the world is stepping (system 'locked'); call it between "
            "steps",
            plumb_world_set_hit_speed(W, 1));
}

static void what_is_locked_in_a_step(void **state)
{
    fixture *f = *state;
    plumb_system_create(
        W, &(plumb_system_desc){
               .name = "locked", .phase = PLUMB_PHASE_BEGIN, .run = lock_check, .context = f });
    steps(W, 1);
}

static void nothing_is_known_of_no_world(void **state)
{
    (void)state;
    int count = 7;
    assert_null(plumb_world_hit_events(NULL, &count));
    assert_int_equal(count, 0);
    assert_null(plumb_world_sensor_begin_events(NULL, &count));
    assert_null(plumb_world_sensor_end_events(NULL, NULL));
    assert_int_equal(plumb_shape_overlaps(NULL, NULL_, NULL, 0), -1);
    assert_int_equal(plumb_contact_edit_count(NULL), -1);
    assert_int_equal(plumb_contact_edit_get(NULL, 0, NULL), PLUMB_E_NULL);
    assert_int_equal(plumb_contact_edit_set(NULL, 0, NULL), PLUMB_E_NULL);
    assert_int_equal(plumb_world_exclude_pair(NULL, NULL_, NULL_, true), PLUMB_E_NULL);
    assert_int_equal(plumb_material_pair_set(NULL, NULL_, NULL_, NULL), PLUMB_E_NULL);
    assert_int_equal(plumb_material_pair_get(NULL, NULL_, NULL_, NULL), PLUMB_E_NULL);
    assert_int_equal(plumb_world_set_hit_speed(NULL, 0), PLUMB_E_NULL);
    assert_int_equal(plumb_shape_set_sensor(NULL, NULL_, true), PLUMB_E_NULL);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_rule_of_filters),
        cmocka_unit_test(filtered_shapes_pass_through_each_other),
        cmocka_unit_test(a_changed_filter_ends_the_touch),
        cmocka_unit_test(excluded_bodies_pass_through_each_other),
        cmocka_unit_test(queries_ask_the_filter),
        cmocka_unit_test(a_ball_falls_through_a_static_sensor),
        cmocka_unit_test(the_test_is_exact),
        cmocka_unit_test(moving_sensors_see_static_shapes_and_sensors),
        cmocka_unit_test(a_sensor_obeys_its_filter_and_has_no_mass),
        cmocka_unit_test(a_conveyor_carries_a_box_at_its_speed),
        cmocka_unit_test(a_rolling_disc_stops_where_it_should),
        cmocka_unit_test(rolling_resistance_holds_a_disc_on_a_slope),
        cmocka_unit_test(materials_mix_by_rule_or_table),
        API_TEST(the_pair_table_is_kept_up),
        cmocka_unit_test(a_pair_can_be_elastic_by_the_table),
        cmocka_unit_test(edits_hold_for_the_step),
        API_TEST(edits_are_refused_out_of_their_phase),
        cmocka_unit_test(a_hit_tells_speed_point_and_impulse),
        cmocka_unit_test(impacts_count_as_impulses),
        cmocka_unit_test(a_chain_is_touched_once),
        cmocka_unit_test(a_joint_of_a_chain_is_hit_once),
        API_TEST(wrong_filters_and_sensors_are_refused),
        API_TEST(wrong_materials_and_speeds_are_refused),
        API_TEST(what_is_locked_in_a_step),
        cmocka_unit_test(nothing_is_known_of_no_world),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
