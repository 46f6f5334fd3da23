// test_api_sleep.c - plumb/sleep.h: falling asleep by itself, by command and by descriptor, events,
// rows, what is seen of sleeping bodies meanwhile, and every refusal. What wakes is in
// test_api_wake.c.
#include "sleep_fixture.h"

#include <stdio.h>

//---- seen in their sleep -------------------------------------------------------------------------

static void contacts_are_seen_and_neither_end_nor_begin(void **state)
{
    (void)state;
    place p = make_place();
    plumb_contact c[4];
    int count, begins, ends;
    for (int round = 0; round < 2; ++round) {
        assert_int_equal(plumb_world_contacts(p.w, NULL, 0), 4);
        assert_int_equal(plumb_body_contacts(p.w, p.low, c, 4), 2);
        double weight = 0;
        for (int i = 0; i < 2; ++i) {
            bool on_floor = plumb_same(c[i].shape_a, p.floor) || plumb_same(c[i].shape_b, p.floor);
            for (int k = 0; on_floor && k < c[i].point_count; ++k) {
                assert_near(c[i].points[k].point.y, 0, 2e-3);
                weight += (double)c[i].points[k].normal_impulse;
            }
        }
        assert_near(weight * 4 * 60, 2 * 9.81, 0.02); // two crates of 1 kg
        assert_int_equal(plumb_body_contacts(p.w, p.ground, NULL, 0), 2);
        assert_int_equal(plumb_world_stats(p.w).contact_count, 4);
        plumb_body_wake(p.w, p.low);
        for (int i = 0; i < 120; ++i) {
            steps(p.w, 1);
            plumb_world_begin_events(p.w, &begins);
            plumb_world_end_events(p.w, &ends);
            assert_int_equal(begins + ends, 0);
        }
        assert_false(plumb_body_is_awake(p.w, p.low));
    }
    // Destroyed in its sleep: what is left has one contact less, whose end is told.
    plumb_body_destroy(p.w, p.high);
    assert_int_equal(plumb_body_contacts(p.w, p.low, NULL, 0), 1);
    steps(p.w, 1);
    plumb_world_end_events(p.w, &ends);
    assert_int_equal(ends, 1);
    // Lifted off in its sleep: the contact ends.
    steps(p.w, 120);
    assert_false(plumb_body_is_awake(p.w, p.low));
    plumb_body_teleport(p.w, p.low, plumb_v2(0, 4), 0);
    steps(p.w, 1);
    const plumb_contact_end *end = plumb_world_end_events(p.w, &count);
    assert_int_equal(count, 1);
    assert_true(plumb_same(end->body_a, p.low) || plumb_same(end->body_b, p.low));
    plumb_world_destroy(p.w);
}

static void queries_see_sleepers(void **state)
{
    (void)state;
    place p = make_place();
    plumb_ray_hit hit;
    plumb_nearest_hit near;
    plumb_shape shapes[8];
    for (int round = 0; round < 3; ++round) {
        assert_true(plumb_world_ray(p.w, plumb_v2(-3, R(0.5)), plumb_v2(3, R(0.5)), NULL, &hit));
        assert_true(plumb_same(hit.body, p.low));
        plumb_query_filter moving = { .ignore_static = true }, still = { .ignore_dynamic = true };
        assert_true(plumb_world_nearest(p.w, plumb_v2(5, 3), 9, &moving, &near));
        assert_true(plumb_same(near.body, p.apart));
        assert_false(plumb_world_ray(p.w, plumb_v2(-3, R(0.5)), plumb_v2(3, R(0.5)), &still, &hit));
        plumb_aabb box = { { -1, R(0.1) }, { 6, 2 } };
        assert_int_equal(plumb_world_overlap_aabb(p.w, box, NULL, shapes, 8), 3);
        if (round == 0) { // awake, the entries of their grid still there
            plumb_body_wake(p.w, p.low);
            steps(p.w, 1);
        } else if (round == 1) { // moved in its sleep, no step since
            steps(p.w, 120);
            assert_int_equal(plumb_world_stats(p.w).asleep_count, 5);
            plumb_body_teleport(p.w, p.high, plumb_v2(20, R(7.5)), 0);
            assert_true(plumb_world_ray(p.w, plumb_v2(15, 7), plumb_v2(25, 7), NULL, &hit));
            assert_true(plumb_same(hit.body, p.high));
            plumb_body_teleport(p.w, p.high, plumb_v2(R(0.1), R(1.5)), 0);
        }
    }
    plumb_body_destroy(p.w, p.low);
    assert_false(plumb_world_ray(p.w, plumb_v2(-3, R(0.5)), plumb_v2(3, R(0.5)), NULL, &hit));
    plumb_world_destroy(p.w);
}

static void sensor_events(const plumb_world *w, int *begins, int *ends)
{
    plumb_world_sensor_begin_events(w, begins);
    plumb_world_sensor_end_events(w, ends);
}

static void sensors_see_sleepers(void **state)
{
    (void)state;
    place p = make_place();
    int begins, ends;
    plumb_shape seen[8];
    plumb_body zone =
        plumb_body_create(p.w, &(plumb_body_desc){ .type = PLUMB_STATIC, .position = { 0, 1 } });
    plumb_shape eye = plumb_shape_create(
        p.w, zone, &(plumb_shape_desc){ .kind = PLUMB_BOX, .half = { 2, 2 }, .sensor = true });
    steps(p.w, 1);
    assert_int_equal(plumb_world_stats(p.w).asleep_count, 5); // a sensor wakes nobody
    sensor_events(p.w, &begins, &ends);
    assert_int_equal(begins, 2); // placed over them
    assert_int_equal(plumb_shape_overlaps(p.w, eye, seen, 8), 2);
    steps(p.w, 3);
    sensor_events(p.w, &begins, &ends);
    assert_int_equal(begins + ends, 0);
    assert_int_equal(plumb_shape_overlaps(p.w, eye, seen, 8), 2);
    // Waking and falling asleep are no events.
    plumb_body_wake(p.w, p.low);
    for (int i = 0; i < 120; ++i) {
        steps(p.w, 1);
        sensor_events(p.w, &begins, &ends);
        assert_int_equal(begins + ends, 0);
        assert_int_equal(plumb_shape_overlaps(p.w, eye, seen, 8), 2);
    }
    assert_int_equal(plumb_world_stats(p.w).asleep_count, 5);
    // Destroyed in its sleep; then the sensor is taken away.
    plumb_body_destroy(p.w, p.high);
    steps(p.w, 1);
    sensor_events(p.w, &begins, &ends);
    assert_int_equal(begins, 0);
    assert_int_equal(ends, 1);
    steps(p.w, 120);
    plumb_body_teleport(p.w, zone, plumb_v2(-30, 1), 0);
    steps(p.w, 1);
    sensor_events(p.w, &begins, &ends);
    assert_int_equal(begins, 0);
    assert_int_equal(ends, 1);
    assert_int_equal(plumb_shape_overlaps(p.w, eye, seen, 8), 0);
    // A sensor that moves, over sleepers; and one that sleeps.
    plumb_body scanner = plumb_body_create(
        p.w,
        &(plumb_body_desc){ .type = PLUMB_KINEMATIC, .position = { 3, 3 }, .velocity = { 2, 0 } });
    plumb_shape beam = plumb_shape_create(
        p.w, scanner,
        &(plumb_shape_desc){ .kind = PLUMB_BOX, .half = { R(0.1), 5 }, .sensor = true });
    int all_begins = 0, all_ends = 0;
    for (int i = 0; i < 120; ++i) {
        steps(p.w, 1);
        sensor_events(p.w, &begins, &ends);
        all_begins += begins, all_ends += ends;
    }
    assert_int_equal(all_begins, 2); // the floor and one crate
    assert_int_equal(all_ends, 1);
    assert_int_equal(plumb_shape_overlaps(p.w, beam, seen, 8), 1);
    assert_false(plumb_body_is_awake(p.w, p.apart));
    plumb_world_destroy(p.w);
}

static void a_sensor_may_sleep(void **state)
{
    (void)state;
    place p = make_place();
    int begins, ends;
    plumb_shape feeler = plumb_shape_create(
        p.w, p.high, &(plumb_shape_desc){ .kind = PLUMB_CIRCLE, .radius = 1, .sensor = true });
    steps(p.w, 1);
    sensor_events(p.w, &begins, &ends);
    assert_int_equal(begins, 1); // the lower crate
    for (int i = 0; i < 150; ++i) {
        steps(p.w, 1);
        sensor_events(p.w, &begins, &ends);
        assert_int_equal(begins + ends, 0);
    }
    assert_false(plumb_body_is_awake(p.w, p.high));
    assert_int_equal(plumb_shape_overlaps(p.w, feeler, NULL, 0), 1);
    // What flies by is seen, and wakes nobody.
    plumb_body ball = plumb_body_create(
        p.w, &(plumb_body_desc){ .position = { R(1.05), 2 }, .velocity = { 0, 1 } });
    plumb_shape_create(p.w, ball, &(plumb_shape_desc){ .kind = PLUMB_CIRCLE, .radius = R(0.1) });
    steps(p.w, 1);
    sensor_events(p.w, &begins, &ends);
    assert_int_equal(begins, 1);
    assert_false(plumb_body_is_awake(p.w, p.high));
    plumb_world_destroy(p.w);
}

//---- by command, by descriptor -------------------------------------------------------------------

static void bodies_are_put_to_sleep(void **state)
{
    (void)state;
    place p = make_place();
    int events;
    plumb_body_apply_impulse_center(p.w, p.high, plumb_v2(1, 1));
    steps(p.w, 3);
    plumb_vec2 at = plumb_body_position(p.w, p.high);
    assert_int_equal(plumb_body_sleep(p.w, p.high), PLUMB_OK);
    assert_false(plumb_body_is_awake(p.w, p.high));
    assert_vec_near(plumb_body_velocity(p.w, p.high), 0, 0, 0);
    assert_int_equal(plumb_body_sleep(p.w, p.high), PLUMB_OK); // it does
    steps(p.w, 60);
    plumb_world_sleep_events(p.w, &events);
    assert_int_equal(events, 0);
    assert_vec_near(plumb_body_position(p.w, p.high), at.x, at.y, 0); // even in mid-air
    // With what it touches.
    plumb_body_teleport(p.w, p.high, plumb_v2(R(0.1), R(1.5)), 0);
    steps(p.w, 5);
    assert_true(plumb_body_is_awake(p.w, p.low));
    assert_int_equal(plumb_body_sleep(p.w, p.low), PLUMB_OK);
    assert_false(plumb_body_is_awake(p.w, p.high));
    assert_true(plumb_body_contacts(p.w, p.low, NULL, 0) >= 1);
    // A push, and second thoughts.
    plumb_body_apply_impulse_center(p.w, p.low, plumb_v2(1, 0));
    assert_true(plumb_body_is_awake(p.w, p.low));
    assert_int_equal(plumb_body_sleep(p.w, p.low), PLUMB_OK);
    assert_false(plumb_body_is_awake(p.w, p.low));
    assert_vec_near(plumb_body_velocity(p.w, p.low), 0, 0, 0);
    steps(p.w, 2);
    assert_false(plumb_body_is_awake(p.w, p.low));
    plumb_world_destroy(p.w);
}

static void bodies_may_start_asleep(void **state)
{
    (void)state;
    plumb_world *w;
    assert_int_equal(plumb_world_create(&(plumb_world_desc){ 0 }, &w), PLUMB_OK);
    const plumb_shape_desc box = { .kind = PLUMB_BOX, .half = { R(0.5), R(0.5) } };
    plumb_body a = plumb_body_create(w, &(plumb_body_desc){ .asleep = true });
    plumb_shape_create(w, a, &box);
    plumb_body_set_mass(w, a, 5);
    plumb_body_teleport(w, a, plumb_v2(0, 5), 0);
    plumb_body b =
        plumb_command_body_create(w, &(plumb_body_desc){ .position = { 1, 5 }, .asleep = true });
    plumb_command_shape_create(w, b, &box);
    plumb_commands_apply(w);
    plumb_joint_create(w, &(plumb_joint_desc){ .kind = PLUMB_WELD, .body_a = a, .body_b = b });
    assert_false(plumb_body_is_awake(w, a));
    steps(w, 60);
    assert_int_equal(plumb_world_stats(w).island_count, 2);
    assert_vec_near(plumb_body_position(w, a), 0, 5, 0);
    plumb_body_set_mass(w, a, 6); // a step has seen it
    steps(w, 1);
    assert_true(plumb_body_is_awake(w, a) && plumb_body_is_awake(w, b)); // joined
    // Pushed before the first step.
    plumb_body c = plumb_body_create(w, &(plumb_body_desc){ .position = { 9, 5 }, .asleep = true });
    plumb_body_set_velocity(w, c, plumb_v2(1, 0));
    steps(w, 1);
    assert_true(plumb_body_is_awake(w, c));
    // A body awake joined to one that starts asleep.
    plumb_body d =
        plumb_body_create(w, &(plumb_body_desc){ .position = { 20, 5 }, .asleep = true });
    plumb_joint_create(w, &(plumb_joint_desc){ .kind = PLUMB_WELD, .body_a = c, .body_b = d });
    steps(w, 1);
    assert_true(plumb_body_is_awake(w, d));
    plumb_world_destroy(w);
    assert_int_equal(plumb_world_create(&(plumb_world_desc){ .no_sleep = true }, &w), PLUMB_OK);
    a = plumb_body_create(w, &(plumb_body_desc){ .asleep = true });
    assert_true(plumb_body_is_awake(w, a));
    plumb_world_destroy(w);
}

static plumb_body slab(plumb_world *w, plumb_body_type type)
{
    plumb_body body = plumb_body_create(w, &(plumb_body_desc){ .type = type });
    plumb_shape_create(w, body, &(plumb_shape_desc){ .kind = PLUMB_BOX, .half = { 5, R(0.5) } });
    return body;
}

// A scene as a level has it: a floor, and a stack that sleeps on it, in whatever order they are made.
static void what_starts_asleep_may_lie_on_something(void **state)
{
    (void)state;
    for (int k = 0; k < 8; ++k) {
        const bool floor_first = k % 2 == 0, stepped = floor_first && k / 2 % 2 == 0,
                   moves = k == 7;
        const plumb_body_type type = k / 4 == 0 ? PLUMB_STATIC : PLUMB_KINEMATIC;
        plumb_world *w;
        assert_int_equal(plumb_world_create(&(plumb_world_desc){ 0 }, &w), PLUMB_OK);
        plumb_body floor = PLUMB_NULL_INIT, crate[3];
        if (floor_first) {
            floor = slab(w, type);
        }
        if (stepped) {
            steps(w, 1);
        }
        for (int i = 0; i < 3; ++i) {
            const plumb_vec2 at = { 0, (plumb_real)(1 + i) };
            crate[i] = plumb_body_create(w, &(plumb_body_desc){ .position = at, .asleep = true });
            plumb_shape_create(
                w, crate[i], &(plumb_shape_desc){ .kind = PLUMB_BOX, .half = { R(0.5), R(0.5) } });
        }
        if (!floor_first) {
            floor = slab(w, type);
        }
        if (moves) {
            plumb_body_set_velocity(w, floor, plumb_v2(R(0.1), 0));
        }
        steps(w, 60);
        for (int i = 0; i < 3; ++i) {
            assert_int_equal(plumb_body_is_awake(w, crate[i]), moves);
        }
        // What comes later is new to them.
        plumb_body tile =
            plumb_body_create(w, &(plumb_body_desc){ .type = type, .position = { 1, 2 } });
        plumb_shape_create(w, tile,
                           &(plumb_shape_desc){ .kind = PLUMB_BOX, .half = { R(0.5), R(0.5) } });
        steps(w, 1);
        for (int i = 0; i < 3; ++i) { // those that it touches, and what these touch
            assert_true(plumb_body_is_awake(w, crate[i]));
        }
        plumb_world_destroy(w);
    }
}

static void sleeping_is_optional(void **state)
{
    (void)state;
    place p = make_place();
    assert_int_equal(plumb_body_set_no_sleep(p.w, p.high, true), PLUMB_OK);
    assert_true(plumb_body_no_sleep(p.w, p.high) && !plumb_body_no_sleep(p.w, p.low));
    steps(p.w, 300);
    assert_true(plumb_body_is_awake(p.w, p.high) && plumb_body_is_awake(p.w, p.low));
    plumb_body_set_no_sleep(p.w, p.high, false);
    steps(p.w, 10);
    assert_false(plumb_body_is_awake(p.w, p.high));
    plumb_world_set_sleep(p.w, false, 0, 0);
    steps(p.w, 300);
    assert_int_equal(plumb_world_stats(p.w).asleep_count, 0);
    assert_true(plumb_world_settings(p.w).no_sleep);
    plumb_world_set_sleep(p.w, true, R(0.2), 2);
    assert_near(plumb_world_settings(p.w).sleep_speed, 0.2, 0);
    assert_near(plumb_world_settings(p.w).sleep_time, 2, 0);
    plumb_world_set_sleep(p.w, true, 0, 0);
    assert_near(plumb_world_settings(p.w).sleep_speed, 0.05, 1e-9);
    assert_near(plumb_world_settings(p.w).sleep_time, 0.5, 0);
    steps(p.w, 60);
    assert_int_equal(plumb_world_stats(p.w).asleep_count, 5);
    plumb_world_destroy(p.w);
}

static void lean(const plumb_system_call *call)
{
    plumb_body_span s = plumb_world_bodies(call->world);
    for (int i = 0; i < s.dynamic_count; ++i) {
        s.fx[i] += R(0.01); // friction holds against it
    }
}

static void a_steady_force_lets_sleep(void **state)
{
    (void)state;
    place p = make_place();
    plumb_system_create(
        p.w, &(plumb_system_desc){ .name = "lean", .phase = PLUMB_PHASE_FORCES, .run = lean });
    const plumb_body all[] = { p.low, p.apart, p.on_ledge, p.hung };
    for (int i = 0; i < 4; ++i) {
        plumb_body_wake(p.w, all[i]);
    }
    steps(p.w, 300);
    assert_int_equal(plumb_world_stats(p.w).asleep_count, 5);
    plumb_system_enable(p.w, "lean", false);
    steps(p.w, 1);
    assert_true(plumb_body_is_awake(p.w, p.apart));
    steps(p.w, 60);
    assert_false(plumb_body_is_awake(p.w, p.apart));
    // Of who sleeps under no force, a call says at once that it wakes; else the step does, by the sum of all.
    plumb_body_apply_force_center(p.w, p.apart, plumb_v2(2, 0));
    assert_true(plumb_body_is_awake(p.w, p.apart));
    for (int i = 0; i < 100; ++i) {
        steps(p.w, 1);
        plumb_body_apply_force_center(p.w, p.apart, plumb_v2(2, 0));
    }
    assert_false(plumb_body_is_awake(p.w, p.apart));
    plumb_body_apply_force_center(p.w, p.apart, plumb_v2(0, 1));
    assert_false(plumb_body_is_awake(p.w, p.apart));
    assert_vec_near(plumb_body_force(p.w, p.apart), 2, 1, 0);
    steps(p.w, 1);
    assert_true(plumb_body_is_awake(p.w, p.apart));
    assert_vec_near(plumb_body_force(p.w, p.apart), 0, 0, 0);
    plumb_world_destroy(p.w);
}

// Forces of sleeping rows are for one step, as those of others are.
static void forces_of_sleeping_rows_do_not_add_up(void **state)
{
    (void)state;
    place p = make_place();
    for (int i = 0; i < 100; ++i) {
        plumb_body_span s = plumb_world_bodies(p.w);
        for (int row = s.count - s.static_count - s.asleep_count; row < s.count - s.static_count;
             ++row) {
            s.fx[row] += R(0.001); // too little to matter
        }
        steps(p.w, 1);
        assert_int_equal(plumb_world_stats(p.w).asleep_count, 5);
        assert_vec_near(plumb_body_force(p.w, p.apart), 0, 0, 0);
    }
    plumb_world_destroy(p.w);
}

static void events_tell_who_slept_and_who_woke(void **state)
{
    (void)state;
    place p = make_place();
    int slept, woken;
    assert_null(plumb_world_sleep_events(p.w, &slept));
    assert_null(plumb_world_wake_events(p.w, &woken));
    plumb_body_wake(p.w, p.low);
    steps(p.w, 1);
    const plumb_body *who = plumb_world_wake_events(p.w, &woken);
    assert_int_equal(woken, 2);
    assert_true(plumb_same(who[0], p.low) && plumb_same(who[1], p.high));
    for (slept = 0; slept == 0;) {
        steps(p.w, 1);
        who = plumb_world_sleep_events(p.w, &slept);
    }
    assert_int_equal(slept, 2);
    assert_true(plumb_same(who[0], p.low) && plumb_same(who[1], p.high));
    steps(p.w, 1);
    plumb_world_sleep_events(p.w, &slept);
    assert_int_equal(slept, 0);
    assert_null(plumb_world_sleep_events(NULL, &slept));
    assert_null(plumb_world_wake_events(NULL, &woken));
    plumb_world_destroy(p.w);
}

static void rows_are_partitioned_as_told(void **state)
{
    (void)state;
    place p = make_place();
    plumb_body_span s = plumb_world_bodies(p.w);
    assert_int_equal(s.dynamic_count, 0);
    assert_int_equal(s.asleep_count, 5);
    assert_true(plumb_same(s.body[0], p.ledge));
    plumb_body_wake(p.w, p.apart);
    steps(p.w, 1);
    plumb_body_wake(p.w, p.low);
    steps(p.w, 1);
    s = plumb_world_bodies(p.w);
    assert_int_equal(s.dynamic_count, 3);
    assert_true(plumb_same(s.body[0], p.apart)); // who wakes comes last
    assert_true(plumb_same(s.body[1], p.low) && plumb_same(s.body[2], p.high));
    assert_true(plumb_same(s.body[3], p.ledge));
    plumb_body_sleep(p.w, p.apart);
    s = plumb_world_bodies(p.w);
    assert_true(plumb_same(s.body[3], p.apart)); // who falls asleep comes first of them
    plumb_world_destroy(p.w);
}

//---- refusals ------------------------------------------------------------------------------------

static plumb_result made_body(fixture *f, plumb_body_desc desc)
{
    return made(f->world, plumb_body_create(f->world, &desc));
}

static void sleep_in_a_system(const plumb_system_call *call)
{
    fixture *f = call->context;
    assert_int_equal(plumb_body_sleep(call->world, f->dynamic), PLUMB_E_LOCKED);
    assert_int_equal(plumb_body_wake(call->world, f->dynamic), PLUMB_OK);
}

static void refusals(void **state)
{
    fixture *f = *state;
    plumb_world *w = f->world;
    const plumb_body null = PLUMB_NULL_INIT;
    REFUSED(E_HANDLE, "plumb_body_wake: body is null; it must be a live body",
            plumb_body_wake(w, null));
    REFUSED(E_HANDLE, "plumb_body_sleep: body is null; it must be a live body",
            plumb_body_sleep(w, null));
    REFUSED(E_STATE, "plumb_body_sleep: body is static; it must be dynamic",
            plumb_body_sleep(w, f->fixed));
    plumb_body_set_enabled(w, f->dynamic, false);
    REFUSED(E_STATE, "plumb_body_sleep: body is disabled; it must be enabled",
            plumb_body_sleep(w, f->dynamic));
    plumb_body_set_enabled(w, f->dynamic, true);
    REFUSED(E_STATE, "plumb_body_sleep: body is kinematic; it must be dynamic",
            plumb_body_sleep(w, f->kinematic));
    REFUSED(E_HANDLE, "plumb_body_set_no_sleep: body is a shape; it must be a live body",
            plumb_body_set_no_sleep(w, (plumb_body){ f->box.entity }, true));
    REFUSED(E_RANGE, "plumb_world_set_sleep: speed is -1; it must be at least 0",
            plumb_world_set_sleep(w, true, -1, 0));
    REFUSED(E_NOT_FINITE, "plumb_world_set_sleep: time is nan; it must be finite",
            plumb_world_set_sleep(w, true, 0, R(NAN)));
    REFUSED(E_RANGE, "plumb_body_create: asleep is true; it must be false for a static body",
            made_body(f, (plumb_body_desc){ .type = PLUMB_STATIC, .asleep = true }));
    REFUSED(E_RANGE, "plumb_body_create: asleep is true; it must be false for a kinematic body",
            made_body(f, (plumb_body_desc){ .type = PLUMB_KINEMATIC, .asleep = true }));
    REFUSED(E_RANGE, "plumb_body_create: asleep is true; it must be false with no_sleep",
            made_body(f, (plumb_body_desc){ .no_sleep = true, .asleep = true }));
    REFUSED(E_RANGE, "plumb_body_create: asleep is true; it must be false for a body that moves",
            made_body(f, (plumb_body_desc){ .velocity = { 1, 0 }, .asleep = true }));
    plumb_body_set_no_sleep(w, f->dynamic, true);
    char message[128];
    snprintf(message, sizeof message,
             "plumb_body_sleep: body is in an island with one that may not sleep (%u:%u)",
             f->dynamic.entity.index, f->dynamic.entity.generation);
    REFUSED(E_STATE, message, plumb_body_sleep(w, f->dynamic));
    plumb_body_set_no_sleep(w, f->dynamic, false);
    plumb_world_set_sleep(w, false, 0, 0);
    REFUSED(E_STATE, "plumb_body_sleep: the world has no_sleep; see plumb_world_set_sleep",
            plumb_body_sleep(w, f->dynamic));
    plumb_world_set_sleep(w, true, 0, 0);
    assert_int_equal(plumb_world_set_sleep(NULL, true, 0, 0), PLUMB_E_NULL);
    assert_int_equal(plumb_body_wake(NULL, null), PLUMB_E_NULL);
    assert_int_equal(plumb_body_sleep(NULL, null), PLUMB_E_NULL);
    assert_int_equal(plumb_body_set_no_sleep(NULL, null, true), PLUMB_E_NULL);
    assert_false(plumb_body_is_awake(w, null) || plumb_body_is_awake(w, f->stale));
    assert_false(plumb_body_is_awake(NULL, null) || plumb_body_no_sleep(NULL, null));
    assert_true(plumb_body_is_awake(w, f->fixed) && plumb_body_is_awake(w, f->kinematic));
    assert_int_equal(plumb_body_wake(w, f->fixed), PLUMB_OK);
    plumb_system_create(
        w, &(plumb_system_desc){ .name = "s", .run = sleep_in_a_system, .context = f });
    assert_int_equal(plumb_world_step(w, R(1.0 / 60)), PLUMB_OK);
}

static void thresholds_are_checked(void **state)
{
    (void)state;
    plumb_world *w;
    const plumb_world_desc bad[] = { { .sleep_speed = -1 }, { .sleep_time = R(NAN) } };
    assert_int_equal(plumb_world_create(&bad[0], &w), PLUMB_E_RANGE);
    assert_int_equal(plumb_world_create(&bad[1], &w), PLUMB_E_NOT_FINITE);
}

// A joint whose only body slept holds it when it has been out of the simulation and in again.
static void joints_of_sleepers_that_were_disabled_hold(void **state)
{
    (void)state;
    plumb_world *w = NULL;
    assert_int_equal(plumb_world_create(&(plumb_world_desc){ 0 }, &w), PLUMB_OK);
    plumb_body b = plumb_body_create(w, &(plumb_body_desc){ .position = { 0, -1 } });
    plumb_shape_create(w, b, &(plumb_shape_desc){ .kind = PLUMB_BOX, .half = { 1, 1 } });
    plumb_joint_create(w, &(plumb_joint_desc){ .body_b = b });
    // Another one that swings on, so that joints are looked through meanwhile.
    plumb_body other =
        plumb_body_create(w, &(plumb_body_desc){ .position = { 9, -1 }, .no_sleep = true });
    plumb_joint_create(w, &(plumb_joint_desc){ .body_b = other, .anchor = { 9, 0 } });
    steps(w, 10);
    assert_int_equal(plumb_body_sleep(w, b), PLUMB_OK);
    steps(w, 1); // the joint is passed over from here on
    plumb_body_set_enabled(w, b, false);
    plumb_body_set_enabled(w, b, true);
    steps(w, 60);
    assert_near(plumb_body_position(w, b).y, -1, 0.01);
    plumb_world_destroy(w);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(contacts_are_seen_and_neither_end_nor_begin),
        cmocka_unit_test(queries_see_sleepers),
        cmocka_unit_test(sensors_see_sleepers),
        cmocka_unit_test(a_sensor_may_sleep),
        cmocka_unit_test(bodies_are_put_to_sleep),
        cmocka_unit_test(bodies_may_start_asleep),
        cmocka_unit_test(what_starts_asleep_may_lie_on_something),
        cmocka_unit_test(sleeping_is_optional),
        cmocka_unit_test(a_steady_force_lets_sleep),
        cmocka_unit_test(forces_of_sleeping_rows_do_not_add_up),
        cmocka_unit_test(events_tell_who_slept_and_who_woke),
        cmocka_unit_test(rows_are_partitioned_as_told),
        API_TEST(refusals),
        cmocka_unit_test(thresholds_are_checked),
        cmocka_unit_test(joints_of_sleepers_that_were_disabled_hold),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
