// test_api_outlive.c - events outlive what they tell of: whatever is destroyed, arrays stay until the next step, stale
// handles can still be compared, and what was destroyed is told to have ended.
#include "world_fixture.h"

#define DT R(1.0 / 60)

typedef struct stage {
    plumb_world *w;
    plumb_body ground, faller, hung, sleeper, watcher;
    plumb_shape floor, box, sensor, bed;
    plumb_joint weak, strong;
} stage;

static plumb_shape add_box(plumb_world *w, plumb_body body, double hx, double hy,
                           plumb_shape_desc d)
{
    d.kind = PLUMB_BOX;
    d.half = plumb_v2(R(hx), R(hy));
    return plumb_shape_create(w, body, &d);
}

static plumb_body add(plumb_world *w, double x, double y)
{
    return plumb_body_create(w, &(plumb_body_desc){ .position = { R(x), R(y) } });
}

// In the step that follows: a box lands within a sensor and hits the ground, one joint breaks and one is strained, one
// body falls asleep.
static stage make_stage(void)
{
    stage s = { .w = NULL };
    assert_int_equal(plumb_world_create(&(plumb_world_desc){ .hit_speed = R(0.5) }, &s.w),
                     PLUMB_OK);
    s.ground = plumb_body_create(s.w, &(plumb_body_desc){ .type = PLUMB_STATIC });
    s.floor = add_box(s.w, s.ground, 30, 1, (plumb_shape_desc){ .center = { 0, -1 } });
    s.watcher = plumb_body_create(s.w, &(plumb_body_desc){ .type = PLUMB_STATIC });
    s.sensor = add_box(s.w, s.watcher, 2, R(0.7), (plumb_shape_desc){ .sensor = true });
    s.sleeper = add(s.w, 10, 0.5);
    s.bed = add_box(s.w, s.sleeper, 0.5, 0.5, (plumb_shape_desc){ 0 });
    s.hung = add(s.w, -10, 5);
    add_box(s.w, s.hung, 0.5, 0.5, (plumb_shape_desc){ 0 });
    plumb_joint_desc joint = { .kind = PLUMB_REVOLUTE, .body_b = s.hung, .anchor = { -10, 5 } };
    s.strong = plumb_joint_create(s.w, &joint);
    s.weak = plumb_joint_create(s.w, &joint);
    s.faller = add(s.w, 0, 3);
    s.box = add_box(s.w, s.faller, 0.5, 0.5, (plumb_shape_desc){ .density = 5 });
    return s;
}

// What the readers give, all arrays in one.
typedef struct told {
    int counts[10];
    char bytes[4096];
    size_t size;
} told;

static void keep(told *t, int which, const void *events, int count, size_t stride)
{
    t->counts[which] = count;
    assert_true(t->size + (size_t)count * stride <= sizeof t->bytes);
    if (count > 0) {
        memcpy(t->bytes + t->size, events, (size_t)count * stride);
    }
    t->size += (size_t)count * stride;
}

enum { BEGIN, END, HIT, SENSOR_IN, SENSOR_OUT, BROKE, STRAINED, ASLEEP, AWAKE, OUT };

static told hear(const plumb_world *w)
{
    told t = { .size = 0 };
    int n;
    const void *e = plumb_world_begin_events(w, &n);
    keep(&t, BEGIN, e, n, sizeof(plumb_contact_begin));
    e = plumb_world_end_events(w, &n);
    keep(&t, END, e, n, sizeof(plumb_contact_end));
    e = plumb_world_hit_events(w, &n);
    keep(&t, HIT, e, n, sizeof(plumb_contact_hit));
    e = plumb_world_sensor_begin_events(w, &n);
    keep(&t, SENSOR_IN, e, n, sizeof(plumb_sensor_event));
    e = plumb_world_sensor_end_events(w, &n);
    keep(&t, SENSOR_OUT, e, n, sizeof(plumb_sensor_event));
    e = plumb_world_joint_break_events(w, &n);
    keep(&t, BROKE, e, n, sizeof(plumb_joint_break));
    e = plumb_world_joint_strain_events(w, &n);
    keep(&t, STRAINED, e, n, sizeof(plumb_joint_strain));
    e = plumb_world_sleep_events(w, &n);
    keep(&t, ASLEEP, e, n, sizeof(plumb_body));
    e = plumb_world_wake_events(w, &n);
    keep(&t, AWAKE, e, n, sizeof(plumb_body));
    e = plumb_world_quarantine_events(w, &n);
    keep(&t, OUT, e, n, sizeof(plumb_quarantine));
    return t;
}

static void events_stay_until_the_next_step(void **state)
{
    (void)state;
    bool seen[10] = { false };
    stage s = make_stage();
    for (int i = 0; i < 120; ++i) {
        if (i == 20) {
            plumb_joint_set_event(s.w, s.strong, 1, 0);
            plumb_joint_set_break(s.w, s.weak, 1, 0);
        }
        plumb_world_step(s.w, DT);
        const told before = hear(s.w);
        bool any = false;
        for (int k = 0; k < 10; ++k) {
            any |= before.counts[k] > 0 && !seen[k];
            seen[k] |= before.counts[k] > 0;
        }
        if (!any) {
            continue;
        }
        // All that there is goes, and other things take the slots; the events are the same to the byte.
        stage copy = make_stage();
        for (int k = 0; k <= i; ++k) {
            if (k == 20) {
                plumb_joint_set_event(copy.w, copy.strong, 1, 0);
                plumb_joint_set_break(copy.w, copy.weak, 1, 0);
            }
            plumb_world_step(copy.w, DT);
        }
        const told first = hear(copy.w);
        assert_memory_equal(before.counts, first.counts, sizeof before.counts);
        plumb_body all[] = { copy.ground, copy.faller, copy.hung, copy.sleeper, copy.watcher };
        for (int k = 0; k < 5; ++k) {
            assert_int_equal(plumb_body_destroy(copy.w, all[k]), PLUMB_OK);
        }
        for (int k = 0; k < 40; ++k) {
            const plumb_body other = add(copy.w, 3 * k, 40);
            add_box(copy.w, other, 0.5, 0.5, (plumb_shape_desc){ 0 });
            plumb_joint_create(copy.w, &(plumb_joint_desc){ .kind = PLUMB_WELD, .body_b = other });
        }
        const told after = hear(copy.w);
        assert_memory_equal(first.counts, after.counts, sizeof first.counts);
        assert_memory_equal(first.bytes, after.bytes, first.size);
        plumb_world_destroy(copy.w);
    }
    assert_true(seen[BEGIN] && seen[HIT] && seen[SENSOR_IN] && seen[BROKE] && seen[STRAINED] &&
                seen[ASLEEP]);
    plumb_world_destroy(s.w);
}

// After a destruction: ends with the handles of before, which no call takes and no new handle equals.
static void what_goes_is_told_to_have_ended(void **state)
{
    (void)state;
    for (int refresh = 0; refresh < 2; ++refresh) {
        stage s = make_stage();
        int count;
        for (int i = 0; i < 60; ++i) {
            plumb_body_wake(s.w, s.faller);
            plumb_body_wake(s.w, s.hung);
            plumb_world_step(s.w, DT);
        }
        assert_false(plumb_body_is_awake(s.w, s.sleeper));
        assert_int_equal(plumb_body_destroy(s.w, s.faller), PLUMB_OK);
        assert_int_equal(plumb_body_destroy(s.w, s.sleeper), PLUMB_OK);
        assert_int_equal(plumb_body_destroy(s.w, s.hung), PLUMB_OK); // its joints go
        plumb_shape newcomers[30];
        for (int k = 0; k < 30; ++k) { // in the slots that are free
            newcomers[k] = add_box(s.w, add(s.w, 3 * k, 40), 0.5, 0.5, (plumb_shape_desc){ 0 });
        }
        assert_int_equal(plumb_world_step(s.w, refresh == 0 ? DT : 0), PLUMB_OK);
        const plumb_contact_end *end = plumb_world_end_events(s.w, &count);
        assert_int_equal(count, 2);
        int of_box = 0, of_bed = 0;
        for (int k = 0; k < count; ++k) {
            const bool first = plumb_same(end[k].shape_b, s.floor);
            const plumb_shape gone = first ? end[k].shape_a : end[k].shape_b;
            const plumb_body body = first ? end[k].body_a : end[k].body_b;
            assert_true(plumb_same(first ? end[k].shape_b : end[k].shape_a, s.floor));
            of_box += plumb_same(gone, s.box) && plumb_same(body, s.faller);
            of_bed += plumb_same(gone, s.bed) && plumb_same(body, s.sleeper); // it slept
            assert_false(plumb_shape_valid(s.w, gone));
            assert_true(plumb_is_null(plumb_shape_body(s.w, gone)));
        }
        assert_true(of_box == 1 && of_bed == 1);
        const plumb_sensor_event *out = plumb_world_sensor_end_events(s.w, &count);
        assert_int_equal(count, 1);
        assert_true(plumb_same(out->shape, s.box) && plumb_same(out->sensor, s.sensor));
        for (int k = 0; k < 30; ++k) {
            assert_false(plumb_same(newcomers[k], s.box) || plumb_same(newcomers[k], s.bed));
        }
        plumb_world_joint_break_events(s.w, &count);
        assert_int_equal(count, 0);
        plumb_world_step(s.w, DT);
        plumb_world_end_events(s.w, &count);
        assert_int_equal(count, 0); // once
        plumb_world_destroy(s.w);
    }
}

// A sensor that goes ends what it saw.
static void a_sensor_that_goes_tells_ends(void **state)
{
    (void)state;
    stage s = make_stage();
    int count;
    for (int i = 0; i < 60; ++i) {
        plumb_world_step(s.w, DT);
    }
    plumb_body_destroy(s.w, s.watcher);
    plumb_body_destroy(s.w, s.faller);
    plumb_world_step(s.w, DT);
    const plumb_sensor_event *out = plumb_world_sensor_end_events(s.w, &count);
    assert_int_equal(count, 1);
    assert_true(plumb_same(out->sensor, s.sensor) && plumb_same(out->sensor_body, s.watcher));
    assert_true(plumb_same(out->shape, s.box) && plumb_same(out->body, s.faller));
    plumb_world_destroy(s.w);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(events_stay_until_the_next_step),
        cmocka_unit_test(what_goes_is_told_to_have_ended),
        cmocka_unit_test(a_sensor_that_goes_tells_ends),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
