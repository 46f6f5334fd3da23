// test_api_event.c - begin and end events, and contacts as they are read after a step.
#include "world_fixture.h"

#define DT R(0.015625) // 1/64 s

typedef struct scene {
    plumb_world *world;
    plumb_body ground, ball;
    plumb_shape floor, circle;
} scene;

// A disc of radius 0.5 whose centre is `height` above the floor.
static scene drop(double height)
{
    scene s;
    assert_int_equal(plumb_world_create(NULL, &s.world), PLUMB_OK);
    s.ground = plumb_body_create(s.world, &(plumb_body_desc){ .type = PLUMB_STATIC });
    s.floor = plumb_shape_create(
        s.world, s.ground,
        &(plumb_shape_desc){ .kind = PLUMB_BOX, .half = { 10, 1 }, .center = { 0, -1 } });
    s.ball = plumb_body_create(s.world, &(plumb_body_desc){ .position = { 0, R(height) } });
    s.circle = plumb_shape_create(s.world, s.ball,
                                  &(plumb_shape_desc){ .kind = PLUMB_CIRCLE, .radius = R(0.5) });
    return s;
}

static int begins(const scene *s)
{
    int count;
    plumb_world_begin_events(s->world, &count);
    return count;
}

static int ends(const scene *s)
{
    int count;
    plumb_world_end_events(s->world, &count);
    return count;
}

// Steps until a begin event comes; fails after `most` steps.
static void step_until_touch(scene *s, int most)
{
    for (int i = 0; i < most; ++i) {
        assert_int_equal(plumb_world_step(s->world, DT), PLUMB_OK);
        if (begins(s) > 0) {
            return;
        }
    }
    fail_msg("no begin event within %d steps", most);
}

#define pair_is(a, b, x, y)                                                                        \
    ((plumb_same(a, x) && plumb_same(b, y)) || (plumb_same(a, y) && plumb_same(b, x)))

static void a_touch_begins_once_and_ends_once(void **state)
{
    (void)state;
    scene s = drop(1.5);
    int count = -1;
    assert_null(plumb_world_begin_events(s.world, &count));
    assert_int_equal(count, 0);
    step_until_touch(&s, 64);
    const plumb_contact_begin *e = plumb_world_begin_events(s.world, &count);
    assert_int_equal(count, 1);
    assert_true(pair_is(e->shape_a, e->shape_b, s.circle, s.floor));
    assert_true(pair_is(e->body_a, e->body_b, s.ball, s.ground));
    double up = plumb_same(e->body_b, s.ball) ? 1 : -1; // the normal points from A to B
    assert_near(e->normal.y, up, ROUNDED(1e-6));
    assert_near(e->point.y, 0, ROUNDED(0.1));
    assert_near(e->approach_speed, sqrt(2 * 9.81), 0.4);
    for (int i = 0; i < 20; ++i) {
        plumb_world_step(s.world, DT);
        assert_int_equal(begins(&s) + ends(&s), 0);
    }
    plumb_body_set_velocity(s.world, s.ball, plumb_v2(0, 5));
    int ended = 0;
    for (int i = 0; i < 20; ++i) {
        plumb_world_step(s.world, DT);
        const plumb_contact_end *end = plumb_world_end_events(s.world, &count);
        if (count > 0) {
            assert_true(pair_is(end->shape_a, end->shape_b, s.circle, s.floor));
            assert_true(pair_is(end->body_a, end->body_b, s.ball, s.ground));
        }
        ended += count;
    }
    assert_int_equal(ended, 1);
    plumb_world_destroy(s.world);
}

static void contacts_of_a_resting_body_hold_its_weight(void **state)
{
    (void)state;
    scene s = drop(0.5);
    for (int i = 0; i < 64; ++i) {
        plumb_world_step(s.world, DT);
    }
    plumb_contact c;
    assert_int_equal(plumb_world_contacts(s.world, &c, 1), 1);
    assert_true(pair_is(c.shape_a, c.shape_b, s.circle, s.floor));
    assert_true(pair_is(c.body_a, c.body_b, s.ball, s.ground));
    assert_int_equal(c.point_count, 1);
    assert_near(c.friction, 0.6, ROUNDED(1e-6));
    assert_near(c.restitution, 0, 0);
    assert_near(plumb_abs(c.normal.y), 1, ROUNDED(1e-6));
    const plumb_contact_point *p = &c.points[0];
    assert_near(p->point.x, 0, ROUNDED(1e-3));
    // Midway between the surfaces: half of the separation above the floor.
    assert_near(p->separation, plumb_body_position(s.world, s.ball).y - R(0.5), ROUNDED(1e-5));
    assert_near(p->point.y, p->separation / 2, ROUNDED(1e-5));
    plumb_real weight = plumb_body_mass(s.world, s.ball) * R(9.81);
    int substeps = plumb_world_settings(s.world).substeps;
    assert_near(p->normal_impulse, weight * DT / (plumb_real)substeps, 1e-3 * weight * DT);
    assert_int_equal(plumb_world_contacts(s.world, NULL, 0), 1);
    assert_int_equal(plumb_body_contacts(s.world, s.ground, &c, 1), 1);
    assert_int_equal(plumb_body_contacts(s.world, s.ball, NULL, 0), 1);
    plumb_body other = plumb_body_create(s.world, &(plumb_body_desc){ .position = { 0, 50 } });
    assert_int_equal(plumb_body_contacts(s.world, other, &c, 1), 0);
    assert_int_equal(plumb_world_stats(s.world).contact_count, 1);
    plumb_world_destroy(s.world);
}

static void a_changed_material_holds_from_the_next_step(void **state)
{
    (void)state;
    scene s = drop(0.5);
    const plumb_material none = PLUMB_NULL_INIT;
    plumb_material_set(s.world, none, &(plumb_material_desc){ .friction = R(0.25) });
    plumb_contact c;
    plumb_world_step(s.world, DT);
    assert_int_equal(plumb_world_contacts(s.world, &c, 1), 1);
    assert_near(c.friction, 0.25, ROUNDED(1e-6));
    plumb_material rough = plumb_material_create(s.world, &(plumb_material_desc){ .friction = 1 });
    plumb_shape_set_material(s.world, s.circle, rough);
    plumb_world_step(s.world, DT);
    assert_int_equal(plumb_world_contacts(s.world, &c, 1), 1);
    assert_near(c.friction, 0.5, 1e-6); // sqrt(1 x 0.25)
    plumb_world_destroy(s.world);
}

static void contacts_and_events_survive_what_happens_between_steps(void **state)
{
    (void)state;
    scene s = drop(0.5);
    for (int i = 0; i < 10; ++i) {
        plumb_world_step(s.world, DT);
    }
    plumb_contact c;
    assert_int_equal(plumb_world_contacts(s.world, &c, 1), 1);
    // Rows of bodies move: the contact is told with the same bodies as before.
    plumb_body_create(s.world, &(plumb_body_desc){ .type = PLUMB_KINEMATIC });
    plumb_body_create(s.world, &(plumb_body_desc){ 0 });
    assert_int_equal(plumb_world_contacts(s.world, &c, 1), 1);
    assert_true(pair_is(c.body_a, c.body_b, s.ball, s.ground));
    plumb_shape_destroy(s.world, s.circle);
    assert_int_equal(plumb_world_contacts(s.world, &c, 1), 0);
    // The slot is taken by another shape: it has no part in the old contact.
    plumb_shape_create(s.world, s.ball,
                       &(plumb_shape_desc){ .kind = PLUMB_CIRCLE, .radius = R(0.5) });
    assert_int_equal(plumb_world_contacts(s.world, &c, 1), 0);
    assert_int_equal(plumb_world_step(s.world, DT), PLUMB_OK);
    assert_int_equal(begins(&s), 1);
    plumb_body_destroy(s.world, s.ground);
    assert_int_equal(plumb_world_contacts(s.world, &c, 1), 0);
    assert_int_equal(plumb_world_step(s.world, DT), PLUMB_OK);
    assert_int_equal(begins(&s), 0);
    plumb_body_destroy(s.world, s.ball);
    assert_int_equal(plumb_world_step(s.world, DT), PLUMB_OK);
    assert_int_equal(plumb_world_contacts(s.world, &c, 1), 0);
    plumb_world_destroy(s.world);
}

static void nothing_is_known_of_no_world(void **state)
{
    (void)state;
    const plumb_body none = PLUMB_NULL_INIT;
    int count = 7;
    assert_null(plumb_world_begin_events(NULL, &count));
    assert_int_equal(count, 0);
    assert_null(plumb_world_end_events(NULL, NULL));
    assert_int_equal(plumb_world_contacts(NULL, NULL, 0), 0);
    assert_int_equal(plumb_body_contacts(NULL, none, NULL, 0), 0);
    scene s = drop(5);
    assert_int_equal(plumb_body_contacts(s.world, (plumb_body){ s.circle.entity }, NULL, 0), 0);
    plumb_world_destroy(s.world);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_touch_begins_once_and_ends_once),
        cmocka_unit_test(contacts_of_a_resting_body_hold_its_weight),
        cmocka_unit_test(a_changed_material_holds_from_the_next_step),
        cmocka_unit_test(contacts_and_events_survive_what_happens_between_steps),
        cmocka_unit_test(nothing_is_known_of_no_world),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
