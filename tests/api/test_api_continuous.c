// test_api_continuous.c - continuous collision as a user sees it: who asks, what may be passed all the
// same, what is told about it. Whether it holds is tests/stability/test_tunnelling.c.
#include "contact_fixture.h"

// [rad/s] of a rod that would turn by 51.5 rad in a step: eight turns and 70 degrees.
#define SPIN      (51.5 / 0.015625)
#define PI_OVER_6 0.5236

static plumb_world *space(plumb_world_desc desc)
{
    desc.zero_gravity = true;
    return flat_world(desc);
}

// Half width and height of a wall whose right face is at x = -1.
static plumb_shape add_wall(plumb_world *w, plumb_shape_desc desc)
{
    plumb_body wall = plumb_body_create(
        w, &(plumb_body_desc){ .type = PLUMB_STATIC, .position = { R(-1.01), 0 } });
    desc.kind = PLUMB_BOX;
    desc.half = plumb_v2(R(0.01), 5);
    return plumb_shape_create(w, wall, &desc);
}

// A rod of 4 m in x = 0, hinged to nothing, that turns into the wall and far beyond.
static plumb_body add_rod(plumb_world *w, plumb_shape_desc desc)
{
    plumb_body rod = plumb_body_create(w, &(plumb_body_desc){ .angular_velocity = R(SPIN) });
    desc.kind = PLUMB_BOX;
    desc.half = plumb_v2(R(0.01), 2);
    plumb_shape_create(w, rod, &desc);
    return rod;
}

static plumb_stats after_a_step(plumb_world *w)
{
    steps(w, 1);
    return plumb_world_stats(w);
}

static void a_body_says_whether_it_asks(void **state)
{
    fixture *f = *state;
    plumb_body b = plumb_body_create(W, &(plumb_body_desc){ .continuous = true });
    assert_true(plumb_body_is_continuous(W, b));
    assert_int_equal(plumb_body_set_continuous(W, b, false), PLUMB_OK);
    assert_false(plumb_body_is_continuous(W, b));
    assert_false(plumb_body_is_continuous(W, f->dynamic));
    assert_int_equal(plumb_body_set_continuous(W, f->dynamic, true), PLUMB_OK);
    assert_int_equal(plumb_body_set_continuous(W, f->dynamic, true), PLUMB_OK);
    assert_true(plumb_body_is_continuous(W, f->dynamic));
    assert_false(plumb_body_is_continuous(W, f->stale));
    assert_false(plumb_body_is_continuous(NULL, b));
    // The flag says nothing about turning.
    assert_int_equal(plumb_body_set_fixed_rotation(W, f->dynamic, true), PLUMB_OK);
    assert_true(plumb_body_is_continuous(W, f->dynamic));
    assert_int_equal(plumb_body_destroy(W, f->dynamic), PLUMB_OK);
}

static const char *reason_of(const plumb_world *w, bool *scheduled)
{
    plumb_pass_info rows[128];
    int count = plumb_world_schedule(w, rows, 128);
    for (int i = 0; i < count; ++i) {
        if (strcmp(rows[i].name, "continuous") == 0) {
            *scheduled = rows[i].scheduled;
            return rows[i].reason;
        }
    }
    fail_msg("no such pass");
    return NULL;
}

static void expect_reason(const plumb_world *w, bool scheduled, const char *reason)
{
    bool is_scheduled;
    assert_string_equal(reason_of(w, &is_scheduled), reason);
    assert_int_equal(is_scheduled, scheduled);
}

static void the_schedule_tells_why(void **state)
{
    (void)state;
    plumb_world *w = space((plumb_world_desc){ 0 });
    expect_reason(w, false, "no awake dynamic body has a shape that could meet another");
    plumb_body a = add_disc(w, 0, 0, (plumb_shape_desc){ 0 }, NULL);
    add_disc(w, 3, 0, (plumb_shape_desc){ 0 }, NULL);
    expect_reason(w, false, "nothing is there that must not be passed through");
    plumb_body_set_continuous(w, a, true);
    expect_reason(w, true, "some body asks not to pass through moving ones");
    plumb_body_create(w, &(plumb_body_desc){ .type = PLUMB_KINEMATIC });
    expect_reason(w, true, "bodies that move fast might pass through kinematic ones");
    plumb_shape wall = add_wall(w, (plumb_shape_desc){ 0 });
    expect_reason(w, true, "bodies that move fast might pass through static shapes");
    plumb_shape_destroy(w, wall);
    expect_reason(w, true, "bodies that move fast might pass through kinematic ones");
    plumb_world_destroy(w);

    w = space((plumb_world_desc){ .no_continuous = true });
    add_disc(w, 0, 0, (plumb_shape_desc){ 0 }, NULL);
    add_wall(w, (plumb_shape_desc){ 0 });
    expect_reason(w, false, "the world asks for no continuous collision");
    assert_true(plumb_world_settings(w).no_continuous);
    plumb_world_destroy(w);
}

static void stats_count_what_was_fast_and_what_stopped(void **state)
{
    (void)state;
    plumb_world *w = space((plumb_world_desc){ 0 });
    add_wall(w, (plumb_shape_desc){ 0 });
    add_disc(w, 3, 4, (plumb_shape_desc){ 0 }, NULL); // slow
    plumb_body rod = add_rod(w, (plumb_shape_desc){ 0 });
    plumb_stats s = after_a_step(w);
    assert_int_equal(s.fast_count, 1);
    assert_int_equal(s.stopped_count, 1);
    // It kept its spin, and the contact takes that in the next step.
    assert_near(plumb_body_angular_velocity(w, rod), SPIN, ROUNDED(1e-3));
    assert_near(plumb_body_angle(w, rod), PI_OVER_6, 0.01);
    s = after_a_step(w);
    assert_true(plumb_body_angular_velocity(w, rod) < R(SPIN / 2));
    plumb_body_teleport(w, rod, plumb_v2(50, 0), 0);
    plumb_body_set_velocity(w, rod, plumb_v2(0, 0));
    plumb_body_set_angular_velocity(w, rod, 0);
    s = after_a_step(w);
    assert_int_equal(s.fast_count, 0); // a teleport is no motion
    assert_int_equal(s.stopped_count, 0);
    plumb_world_destroy(w);

    w = space((plumb_world_desc){ .no_continuous = true });
    add_wall(w, (plumb_shape_desc){ 0 });
    add_rod(w, (plumb_shape_desc){ 0 });
    s = after_a_step(w);
    assert_int_equal(s.fast_count, 0);
    assert_int_equal(s.stopped_count, 0);
    plumb_world_destroy(w);
}

static void expect_pass(plumb_world *w, plumb_body rod, bool passes)
{
    plumb_stats s = after_a_step(w);
    assert_int_equal(s.fast_count, 1);
    assert_int_equal(s.stopped_count, passes ? 0 : 1);
    assert_true(passes == (plumb_abs(plumb_body_angle(w, rod)) > 1));
    plumb_world_destroy(w);
}

static void what_may_be_passed_is_passed(void **state)
{
    (void)state;
    const plumb_shape_desc plain = { 0 }, sensor = { .sensor = true },
                           ghost = { .filter = { .group = -1 } };
    plumb_world *w = space((plumb_world_desc){ 0 });
    add_wall(w, plain);
    expect_pass(w, add_rod(w, plain), false);

    w = space((plumb_world_desc){ 0 });
    add_wall(w, sensor);
    expect_pass(w, add_rod(w, plain), true);

    w = space((plumb_world_desc){ 0 });
    add_wall(w, ghost);
    expect_pass(w, add_rod(w, ghost), true);
    w = space((plumb_world_desc){ 0 });
    add_wall(w, ghost);
    expect_pass(w, add_rod(w, plain), false);

    w = space((plumb_world_desc){ 0 });
    plumb_body wall = plumb_shape_body(w, add_wall(w, plain)), rod = add_rod(w, plain);
    plumb_world_exclude_pair(w, wall, rod, true);
    expect_pass(w, rod, true);

    for (int collide = 0; collide < 2; ++collide) {
        w = space((plumb_world_desc){ 0 });
        wall = plumb_shape_body(w, add_wall(w, plain));
        rod = add_rod(w, plain);
        plumb_joint_create(w, &(plumb_joint_desc){ .body_a = wall,
                                                   .body_b = rod,
                                                   .collide_connected = collide == 1 });
        expect_pass(w, rod, collide == 0);
    }
}

static void waive_all(const plumb_system_call *call)
{
    int *waived = call->context;
    int count = plumb_contact_edit_count(call->world);
    for (int i = 0; i < count; ++i) {
        plumb_contact_edit c;
        assert_int_equal(plumb_contact_edit_get(call->world, i, &c), PLUMB_OK);
        c.enabled = false;
        assert_int_equal(plumb_contact_edit_set(call->world, i, &c), PLUMB_OK);
        ++*waived;
    }
}

// A contact that a system disables stops nothing, for as long as it does so.
static void a_disabled_contact_is_passed(void **state)
{
    (void)state;
    for (int disabled = 0; disabled < 2; ++disabled) {
        int waived = 0;
        plumb_world *w = space((plumb_world_desc){ 0 });
        plumb_system_create(w, &(plumb_system_desc){ .name = "waive",
                                                     .phase = PLUMB_PHASE_CONTACTS,
                                                     .run = waive_all,
                                                     .context = &waived });
        plumb_system_enable(w, "waive", disabled == 1);
        add_wall(w, (plumb_shape_desc){ 0 });
        // It touches the wall already, so that there is a contact to disable.
        plumb_body rod = plumb_body_create(
            w, &(plumb_body_desc){ .position = { R(-0.985), 0 }, .angular_velocity = R(SPIN) });
        plumb_shape_create(w, rod,
                           &(plumb_shape_desc){ .kind = PLUMB_BOX, .half = { R(0.01), 2 } });
        steps(w, 1);
        assert_int_equal(waived, disabled);
        // Thrown back by the impact, or turned by all of 51.5 rad.
        assert_near(plumb_body_angle(w, rod), disabled ? 51.5 - 50.2655 : 0, disabled ? 0.01 : 0.6);
        plumb_system_enable(w, "waive", false);
        plumb_body_teleport(w, rod, plumb_v2(R(-0.985), 0), 0);
        plumb_body_set_velocity(w, rod, plumb_v2(0, 0));
        plumb_body_set_angular_velocity(w, rod, R(SPIN));
        steps(w, 1);
        assert_near(plumb_body_angle(w, rod), 0, 0.6);
        plumb_world_destroy(w);
    }
}

// The speed of an impact that a sweep found is told by the step that resolves it.
static void a_stopped_body_hits_in_the_next_step(void **state)
{
    (void)state;
    plumb_world *w = space((plumb_world_desc){ .hit_speed = 1 });
    plumb_shape wall = add_wall(w, (plumb_shape_desc){ 0 });
    add_rod(w, (plumb_shape_desc){ 0 });
    int count;
    assert_int_equal(after_a_step(w).stopped_count, 1);
    plumb_world_hit_events(w, &count);
    assert_int_equal(count, 0);
    double speed = 0;
    for (int i = 0; i < 3; ++i) {
        steps(w, 1);
        const plumb_contact_hit *hits = plumb_world_hit_events(w, &count);
        for (int k = 0; k < count; ++k) {
            assert_true(plumb_same(hits[k].shape_a, wall) || plumb_same(hits[k].shape_b, wall));
            speed = (double)hits[k].approach_speed > speed ? (double)hits[k].approach_speed : speed;
        }
    }
    // 2 m of arm at the spin, less what the angle of 30 degrees takes: cos(30) of it.
    assert_near(speed, 2 * SPIN * 0.866, 0.1 * SPIN);
    plumb_world_destroy(w);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        API_TEST(a_body_says_whether_it_asks),
        cmocka_unit_test(the_schedule_tells_why),
        cmocka_unit_test(stats_count_what_was_fast_and_what_stopped),
        cmocka_unit_test(what_may_be_passed_is_passed),
        cmocka_unit_test(a_disabled_contact_is_passed),
        cmocka_unit_test(a_stopped_body_hits_in_the_next_step),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
