// test_api_watchdog.c - each detector of the watchdog fires in a world made for it, and names the body, the row of the
// schedule, the step and the last call; and it is silent in the same world without the fault.
#include "world_fixture.h"

#define HZ60 R(1 / 60.0)

typedef struct watched {
    plumb_world *w;
    plumb_alarm first; // of the kind that was asked for
    int count;         // of that kind
    int others;        // of other kinds
} watched;

static plumb_world *watched_world(plumb_world_desc desc)
{
    plumb_world *w;
    desc.watchdog = true;
    assert_int_equal(plumb_world_create(&desc, &w), PLUMB_OK);
    return w;
}

static plumb_body add(plumb_world *w, plumb_body_type type, double x, double y, double hx,
                      double hy)
{
    const plumb_body b =
        plumb_body_create(w, &(plumb_body_desc){ .type = type, .position = { R(x), R(y) } });
    plumb_shape_create(w, b, &(plumb_shape_desc){ .kind = PLUMB_BOX, .half = { R(hx), R(hy) } });
    return b;
}

static watched step_all(plumb_world *w, int steps, plumb_real dt, plumb_alarm_kind kind)
{
    watched r = { .w = w };
    for (int i = 0; i < steps; ++i) {
        int count;
        assert_int_equal(plumb_world_step(w, dt), PLUMB_OK);
        const plumb_alarm *a = plumb_world_alarms(w, &count);
        assert_true((a == NULL) == (count == 0));
        for (int k = 0; k < count; ++k) {
            assert_int_equal(a[k].step, plumb_world_stats(w).step_count);
            if (a[k].kind == kind && r.count++ == 0) {
                r.first = a[k];
            }
            r.others += a[k].kind != kind;
        }
    }
    return r;
}

static void assert_told(const watched *r, plumb_body body, const char *pass, const char *command,
                        uint64_t command_step)
{
    assert_true(r->count > 0);
    assert_true(plumb_same(r->first.body, body));
    assert_string_equal(r->first.pass, pass);
    assert_string_equal(r->first.command, command);
    assert_int_equal(r->first.command_step, command_step);
    assert_true(r->first.value > r->first.bound);
    assert_true(r->first.bound == R(plumb_alarm_bound(r->first.kind)));
}

//---- one a detector ------------------------------------------------------------------------------

// Two links; the second, which hangs on a static anchor, is torn away, or not.
static plumb_world *links(plumb_body link[2], plumb_joint *joint, bool torn)
{
    plumb_world *w = watched_world((plumb_world_desc){ 0 });
    link[0] = add(w, PLUMB_DYNAMIC, 0.5, 0, 0.5, 0.1);
    link[1] = add(w, PLUMB_DYNAMIC, 1.5, 0, 0.5, 0.1);
    plumb_joint_create(w, &(plumb_joint_desc){ .body_a = link[1], .anchor = { 2, 0 } });
    *joint = plumb_joint_create(
        w, &(plumb_joint_desc){ .body_a = link[0], .body_b = link[1], .anchor = { 1, 0 } });
    assert_int_equal(step_all(w, 5, HZ60, PLUMB_ALARM_ENERGY_JUMP).count, 0);
    if (torn) {
        plumb_body_teleport(w, link[1], plumb_v2(9, 0), 0);
    }
    return w;
}

static void a_body_torn_from_its_joint_brings_energy(void **state)
{
    (void)state;
    plumb_body link[2];
    plumb_joint joint;
    plumb_world *w = links(link, &joint, true);
    const watched r = step_all(w, 1, HZ60, PLUMB_ALARM_ENERGY_JUMP);
    assert_told(&r, link[1], "soft step", "plumb_body_teleport", 5);
    assert_int_equal(r.count, 1);
    assert_string_equal(r.first.work, "");
    plumb_world_destroy(w);
    w = links(link, &joint, true);
    plumb_world_set_measure(w, true);
    assert_string_equal(step_all(w, 1, HZ60, PLUMB_ALARM_ENERGY_JUMP).first.work, "joints");
    plumb_world_destroy(w);
    w = links(link, &joint, false);
    const watched calm = step_all(w, 60, HZ60, PLUMB_ALARM_ENERGY_JUMP);
    assert_int_equal(calm.count + calm.others, 0);
    plumb_world_destroy(w);
}

static void and_it_runs_away(void **state)
{
    (void)state;
    plumb_body link[2];
    plumb_joint joint;
    plumb_world *w = links(link, &joint, true);
    plumb_body_apply_force_center(w, link[0], plumb_v2(1, 0));
    const watched r = step_all(w, 1, HZ60, PLUMB_ALARM_RUNAWAY_SPEED);
    assert_told(&r, link[0], "soft step", "plumb_body_apply_force_center", 5);
    plumb_world_destroy(w);
}

// What was given is no runaway, however fast.
static void speed_that_was_given_is_none(void **state)
{
    (void)state;
    plumb_world *w = watched_world((plumb_world_desc){ 0 });
    const plumb_body b = add(w, PLUMB_DYNAMIC, 0, 0, 1, 1);
    step_all(w, 1, HZ60, PLUMB_ALARM_RUNAWAY_SPEED);
    plumb_body_set_velocity(w, b, plumb_v2(900, 0));
    plumb_body_apply_impulse_center(w, b, plumb_v2(R(1e4) * plumb_body_mass(w, b), 0));
    const watched r = step_all(w, 60, HZ60, PLUMB_ALARM_RUNAWAY_SPEED);
    assert_int_equal(r.count + r.others, 0);
    plumb_world_destroy(w);
}

// A force that begins within the step drives a ball through a wall that the narrow phase has not seen.
static watched shot(bool no_continuous)
{
    plumb_world *w =
        watched_world((plumb_world_desc){ .zero_gravity = true, .no_continuous = no_continuous });
    add(w, PLUMB_STATIC, 1, 0, 0.025, 2);
    const plumb_body ball = add(w, PLUMB_DYNAMIC, 0, 0, 0.05, 0.05);
    assert_int_equal(plumb_world_step(w, HZ60), PLUMB_OK);
    plumb_body_apply_force(w, ball, plumb_v2(20000 * plumb_body_mass(w, ball), 0), plumb_v2(0, 0));
    watched r = step_all(w, 1, HZ60, PLUMB_ALARM_TUNNELLING);
    if (no_continuous) {
        assert_told(&r, ball, "motion", "plumb_body_apply_force", 1);
    }
    r.w = NULL;
    plumb_world_destroy(w);
    return r;
}

static void what_passes_through_a_wall_is_told(void **state)
{
    (void)state;
    assert_int_equal(shot(true).count, 1);
    const watched calm = shot(false);
    assert_int_equal(calm.count + calm.others, 0);
}

// What filters, sensors, one-way shapes and joints let pass has not tunnelled.
static void what_may_pass_does_not_tunnel(void **state)
{
    (void)state;
    for (int how = 0; how < 5; ++how) {
        plumb_world *w =
            watched_world((plumb_world_desc){ .zero_gravity = true, .no_continuous = true });
        const plumb_body wall =
            plumb_body_create(w, &(plumb_body_desc){ .type = PLUMB_STATIC, .position = { 1, 0 } });
        plumb_shape_desc d = { .kind = PLUMB_BOX, .half = { R(0.025), 2 } };
        d.sensor = how == 0;
        d.filter.nothing = how == 1;
        d.one_way.direction = how == 2 ? plumb_v2(1, 0) : plumb_v2(0, 0);
        plumb_shape_create(w, wall, &d);
        const plumb_body ball = add(w, PLUMB_DYNAMIC, 0, 0, 0.05, 0.05);
        if (how == 3) {
            plumb_world_exclude_pair(w, wall, ball, true);
        } else if (how == 4) {
            plumb_joint_create(w, &(plumb_joint_desc){ .kind = PLUMB_FRICTION,
                                                       .body_a = wall,
                                                       .body_b = ball,
                                                       .max_force = R(1e-3) });
        }
        plumb_body_apply_force_center(w, ball, plumb_v2(20000 * plumb_body_mass(w, ball), 0));
        assert_int_equal(step_all(w, 2, HZ60, PLUMB_ALARM_TUNNELLING).count, 0);
        assert_true(plumb_body_position(w, ball).x > 2);
        plumb_world_destroy(w);
    }
}

// A heavy box sinks into a light one where sweeps are to hold it, an equal one does not.
static void what_sinks_is_told(void **state)
{
    (void)state;
    for (int heavy = 0; heavy < 2; ++heavy) {
        plumb_world *w = watched_world((plumb_world_desc){ .no_exact_islands = true });
        add(w, PLUMB_STATIC, 0, -0.5, 10, 0.5);
        const plumb_body egg = add(w, PLUMB_DYNAMIC, 0, 0.5, 0.5, 0.5);
        const plumb_body press = add(w, PLUMB_DYNAMIC, 0, 1.5, 2, 0.5);
        plumb_body_set_mass(w, egg, 1);
        plumb_body_set_mass(w, press, heavy ? R(1e5) : 1);
        const watched r = step_all(w, 60, HZ60, PLUMB_ALARM_SINKING);
        assert_int_equal(r.others, 0);
        assert_true((r.count > 0) == (heavy == 1));
        if (heavy) {
            assert_told(&r, egg, "soft step", "plumb_body_set_mass", 0);
            assert_true(plumb_same(r.first.other, press));
        }
        plumb_world_destroy(w);
    }
}

// A rod turns by one and a half radians a substep beside a post: a contact is made where it will not be.
static void a_push_from_afar_is_told(void **state)
{
    (void)state;
    int told = 0;
    for (int coarse = 0; coarse < 2; ++coarse) {
        for (int i = 0; i < 20; ++i) {
            plumb_world *w = watched_world((plumb_world_desc){
                .zero_gravity = true, .no_continuous = true, .substeps = coarse ? 1 : 8 });
            const plumb_body post = add(w, PLUMB_STATIC, 0, 0, 0.1, 0.1);
            const plumb_body rod = add(w, PLUMB_DYNAMIC, 0, 0.22 + 0.05 * i, 1, 0.05);
            plumb_body_set_angular_velocity(w, rod, coarse ? 30 : 2);
            const watched r = step_all(w, coarse ? 20 : 200, coarse ? R(0.05) : R(0.005),
                                       PLUMB_ALARM_CONTACT_WITHOUT_TOUCH);
            assert_int_equal(coarse ? 0 : r.count, 0);
            if (r.count > 0) {
                ++told;
                assert_told(&r, rod, "soft step", "plumb_body_set_angular_velocity", 0);
                assert_true(plumb_same(r.first.other, post));
            }
            plumb_world_destroy(w);
        }
    }
    assert_true(told > 0);
}

static void many_in_one_place_are_told(void **state)
{
    (void)state;
    for (int apart = 0; apart < 2; ++apart) {
        plumb_world *w = watched_world((plumb_world_desc){ .zero_gravity = true });
        plumb_body b[20];
        for (int i = 0; i < 20; ++i) {
            b[i] = add(w, PLUMB_DYNAMIC, 2 * i, 0, 0.5, 0.5);
        }
        assert_int_equal(step_all(w, 2, HZ60, PLUMB_ALARM_PAIR_EXPLOSION).count, 0);
        for (int i = 0; i < 20; ++i) {
            plumb_body_set_position(w, b[i], plumb_v2(apart ? R(3 * i) : R(0.01 * i), 0));
        }
        const watched r = step_all(w, 1, HZ60, PLUMB_ALARM_PAIR_EXPLOSION);
        assert_int_equal(r.count, apart ? 0 : 1);
        if (!apart) {
            assert_told(&r, b[0], "narrow phase", "plumb_body_set_position", 2);
        }
        plumb_world_destroy(w);
    }
}

// A chain of ten links ends at a kinematic body, which stands, or flies off at 5 m/s.
static void a_joint_that_gives_way_is_told(void **state)
{
    (void)state;
    for (int leaves = 0; leaves < 2; ++leaves) {
        plumb_world *w = watched_world((plumb_world_desc){ 0 });
        plumb_body last = PLUMB_NULL_INIT;
        plumb_joint joint[11];
        for (int i = 0; i < 11; ++i) {
            const plumb_body link =
                add(w, i < 10 ? PLUMB_DYNAMIC : PLUMB_KINEMATIC, i + 0.5, 0, 0.5, 0.1);
            if (i == 10 && leaves) {
                plumb_body_set_velocity(w, link, (plumb_vec2){ 5, 0 });
            }
            joint[i] = plumb_joint_create(
                w, &(plumb_joint_desc){ .body_a = last, .body_b = link, .anchor = { R(i), 0 } });
            last = link;
        }
        const watched r = step_all(w, 120, HZ60, PLUMB_ALARM_TORN_JOINT);
        assert_true((r.count > 0) == (leaves == 1));
        if (leaves) {
            int i = 0;
            while (i < 11 && !plumb_same(joint[i], r.first.joint)) {
                ++i;
            }
            assert_true(i < 11);
            assert_told(&r, plumb_joint_body_b(w, joint[i]), "soft step", "plumb_joint_create", 0);
        }
        plumb_world_destroy(w);
    }
}

static void a_drive_too_weak_for_its_load_is_none(void **state)
{
    (void)state;
    plumb_world *w = watched_world((plumb_world_desc){ 0 });
    const plumb_body b = add(w, PLUMB_DYNAMIC, 0, 0, 0.5, 0.5);
    plumb_joint_create(w, &(plumb_joint_desc){ .kind = PLUMB_MOTOR, .body_b = b, .max_force = 1 });
    const watched r = step_all(w, 60, HZ60, PLUMB_ALARM_TORN_JOINT);
    assert_int_equal(r.count, 0);
    plumb_world_destroy(w);
}

static void a_place_beyond_resolution_is_told(void **state)
{
    (void)state;
    plumb_world *w = watched_world((plumb_world_desc){ .zero_gravity = true });
    const plumb_body b = add(w, PLUMB_DYNAMIC, 0, 0, 0.5, 0.5);
    step_all(w, 1, HZ60, PLUMB_ALARM_OUT_OF_SCALE);
    plumb_command_teleport(w, b, plumb_v2(R(9e8), 0), 0);
    const watched r = step_all(w, 1, HZ60, PLUMB_ALARM_OUT_OF_SCALE);
    if (sizeof(plumb_real) == sizeof(float)) {
        assert_told(&r, b, "calls", "plumb_command_teleport", 1);
    } else {
        assert_int_equal(r.count + r.others, 0); // 1e-7 m
    }
    plumb_world_destroy(w);
}

//---- how it is told ------------------------------------------------------------------------------

static void hurl(const plumb_system_call *call)
{
    const plumb_body_span span = plumb_world_bodies(call->world);
    if (plumb_world_stats(call->world).step_count == 3) {
        span.vx[0] = 333;
    }
}

// What a system wrote into columns is its doing: here behind the narrow phase, which has not seen the wall.
static void a_system_is_a_command(void **state)
{
    (void)state;
    plumb_world *w =
        watched_world((plumb_world_desc){ .zero_gravity = true, .no_continuous = true });
    const plumb_body ball = add(w, PLUMB_DYNAMIC, 0, 0, 0.05, 0.05);
    const plumb_body wall = add(w, PLUMB_STATIC, 1, 0, 0.025, 2);
    plumb_system_create(
        w, &(plumb_system_desc){ .name = "hurler", .phase = PLUMB_PHASE_CONTACTS, .run = hurl });
    const watched r = step_all(w, 6, HZ60, PLUMB_ALARM_TUNNELLING);
    assert_told(&r, ball, "motion", "system 'hurler'", 3);
    assert_true(plumb_same(r.first.other, wall));
    assert_int_equal(r.first.step, 4);
    assert_int_equal(r.count + r.others, 1);
    plumb_world_destroy(w);
}

// Once of an entity and kind, until it has been silent.
static void it_is_told_once_until_it_was_silent(void **state)
{
    (void)state;
    plumb_world *w =
        watched_world((plumb_world_desc){ .zero_gravity = true, .no_continuous = true });
    add(w, PLUMB_STATIC, 1, 0, 0.025, 2);
    const plumb_body ball = add(w, PLUMB_DYNAMIC, 0, 0, 0.05, 0.05);
    const plumb_real force = 20000 * plumb_body_mass(w, ball);
    int told = 0;
    for (int i = 0; i < 3; ++i) {
        plumb_body_teleport(w, ball, plumb_v2(0, 0), 0);
        plumb_body_set_velocity(w, ball, plumb_v2(0, 0));
        plumb_body_apply_force_center(w, ball, plumb_v2(force, 0));
        told += step_all(w, 1, HZ60, PLUMB_ALARM_TUNNELLING).count;
        plumb_body_set_velocity(w, ball, plumb_v2(0, 0));
        told += step_all(w, i == 0 ? 5 : PLUMB_ALARM_SILENCE, HZ60, PLUMB_ALARM_TUNNELLING).count;
    }
    assert_int_equal(told, 2);
    assert_int_equal(plumb_world_stats(w).alarm_count, 2);
    plumb_world_destroy(w);
}

static int logged;
static char line[512];

static void take_log(void *context, plumb_log_level level, const char *message)
{
    (void)context;
    logged += level == PLUMB_LOG_WARN;
    strncpy(line, message, sizeof line - 1);
}

static void the_log_is_told(void **state)
{
    (void)state;
    plumb_world *w = watched_world((plumb_world_desc){ .zero_gravity = true, .log = take_log });
    plumb_body b[12];
    for (int i = 0; i < 12; ++i) {
        b[i] = add(w, PLUMB_DYNAMIC, 0.01 * i, 0, 0.5, 0.5);
    }
    (void)b;
    int count;
    logged = 0;
    plumb_world_step(w, HZ60);
    plumb_world_alarms(w, &count);
    assert_true(count > 0);
    assert_int_equal(logged, count);
    assert_non_null(strstr(line, "watchdog: "));
    assert_non_null(strstr(line, "of step 1 (0.0166667 s), after plumb_shape_create"));
    assert_int_equal(plumb_world_stats(w).alarm_count, count);
    plumb_world_step(w, 0);
    assert_null(plumb_world_alarms(w, &count)); // those were of the step before
    plumb_world_destroy(w);
}

static void a_restored_world_is_watched_anew(void **state)
{
    (void)state;
    static unsigned char image[1 << 20];
    plumb_world *w = watched_world((plumb_world_desc){ 0 });
    const plumb_body b = add(w, PLUMB_DYNAMIC, 0, 0, 0.5, 0.5);
    plumb_body_set_velocity(w, b, plumb_v2(70, 0));
    step_all(w, 5, HZ60, PLUMB_ALARM_RUNAWAY_SPEED);
    const size_t size = plumb_world_snapshot_size(w);
    assert_true(size < sizeof image);
    assert_int_equal(plumb_world_save(w, image, size), PLUMB_OK);
    plumb_body_set_velocity(w, b, plumb_v2(0, 0));
    step_all(w, 5, HZ60, PLUMB_ALARM_RUNAWAY_SPEED);
    assert_int_equal(plumb_world_restore(w, image, size), PLUMB_OK);
    const watched r = step_all(w, 60, HZ60, PLUMB_ALARM_RUNAWAY_SPEED); // 70 m/s out of nothing
    assert_int_equal(r.count + r.others, 0);
    plumb_world_destroy(w);
}

static size_t bytes_of(const plumb_world *w)
{
    plumb_memory_row rows[40];
    const int count = plumb_world_memory(w, rows, 40);
    for (int i = 0; i < count; ++i) {
        if (strcmp(rows[i].name, "watchdog") == 0) {
            return rows[i].bytes;
        }
    }
    fail();
    return 0;
}

static bool is_scheduled(const plumb_world *w, const char *name)
{
    plumb_pass_info rows[128];
    const int count = plumb_world_schedule(w, rows, 128);
    for (int i = 0; i < count; ++i) {
        if (strcmp(rows[i].name, name) == 0) {
            return rows[i].scheduled;
        }
    }
    fail();
    return false;
}

static void off_nothing_of_it_is_there(void **state)
{
    fixture *f = *state;
    plumb_world *w = f->world;
    assert_false(plumb_world_settings(w).watchdog);
    for (int on = 0; on < 3; ++on) {
        assert_int_equal(plumb_world_set_watchdog(w, on == 1), PLUMB_OK);
        assert_true(plumb_world_settings(w).watchdog == (on == 1));
        plumb_body_set_velocity(w, f->dynamic, plumb_v2(1, 0));
        assert_int_equal(plumb_world_step(w, R(0.01)), PLUMB_OK);
        assert_true(is_scheduled(w, "watch") == (on == 1));
        assert_true(is_scheduled(w, "watchdog") == (on == 1));
        assert_true((bytes_of(w) > 0) == (on > 0));
    }
}

static void names_and_refusals(void **state)
{
    (void)state;
    int count = 3;
    for (int i = 0; i < PLUMB_ALARM_KINDS; ++i) {
        const plumb_alarm_kind kind = (plumb_alarm_kind)i;
        assert_non_null(plumb_alarm_name(kind));
        assert_true(strlen(plumb_alarm_text(kind)) > 20);
        assert_true(strlen(plumb_alarm_advice(kind)) > 20);
        assert_non_null(plumb_alarm_unit(kind));
        assert_true(plumb_alarm_bound(kind) > 0);
    }
    assert_string_equal(plumb_alarm_name(PLUMB_ALARM_ENERGY_JUMP), "energy-jump");
    assert_null(plumb_alarm_name(PLUMB_ALARM_KINDS));
    assert_null(plumb_alarm_text(PLUMB_ALARM_KINDS));
    assert_null(plumb_alarm_advice(PLUMB_ALARM_KINDS));
    assert_null(plumb_alarm_unit(PLUMB_ALARM_KINDS));
    assert_true(plumb_alarm_bound(PLUMB_ALARM_KINDS) == 0);
    assert_null(plumb_world_alarms(NULL, &count));
    assert_int_equal(count, 0);
    assert_int_equal(plumb_world_set_watchdog(NULL, true), PLUMB_E_NULL);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_body_torn_from_its_joint_brings_energy),
        cmocka_unit_test(and_it_runs_away),
        cmocka_unit_test(speed_that_was_given_is_none),
        cmocka_unit_test(what_passes_through_a_wall_is_told),
        cmocka_unit_test(what_may_pass_does_not_tunnel),
        cmocka_unit_test(what_sinks_is_told),
        cmocka_unit_test(a_push_from_afar_is_told),
        cmocka_unit_test(many_in_one_place_are_told),
        cmocka_unit_test(a_joint_that_gives_way_is_told),
        cmocka_unit_test(a_drive_too_weak_for_its_load_is_none),
        cmocka_unit_test(a_place_beyond_resolution_is_told),
        cmocka_unit_test(a_system_is_a_command),
        cmocka_unit_test(it_is_told_once_until_it_was_silent),
        cmocka_unit_test(the_log_is_told),
        cmocka_unit_test(a_restored_world_is_watched_anew),
        API_TEST(off_nothing_of_it_is_there),
        cmocka_unit_test(names_and_refusals),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
