// test_api_batch_joints.c - joints of a batch: what is gathered, what is driven, every refusal.
#include "world_fixture.h"

#define DT R(1.0 / 60)

enum { WORLDS = 23, JOINTS = 2 };

// A wheel on a hinge with a motor, a sled on a spring; world by world another mass.
static plumb_joint joints[JOINTS];

static plumb_result build(plumb_world *world, uint32_t index, plumb_random *random, void *context)
{
    (void)random, (void)context;
    for (int i = 0; i < JOINTS; ++i) {
        const plumb_body body =
            plumb_body_create(world, &(plumb_body_desc){ .position = { R(4 * i), 0 } });
        plumb_shape_create(world, body,
                           &(plumb_shape_desc){
                               .kind = PLUMB_CIRCLE, .radius = 1, .density = R(1 + 0.1 * index) });
        joints[i] = plumb_joint_create(
            world, &(plumb_joint_desc){ .kind = i == 0 ? PLUMB_REVOLUTE : PLUMB_PRISMATIC,
                                        .body_b = body,
                                        .anchor = { R(4 * i), 0 },
                                        .hertz = i == 0 ? 0 : R(2),
                                        .damping = i == 0 ? 0 : R(1) });
    }
    return plumb_world_error(world).code;
}

static plumb_batch *make(void)
{
    plumb_batch *batch = NULL;
    const plumb_batch_desc desc = { .count = WORLDS, .workers = 2, .build = build };
    assert_int_equal(plumb_batch_create(&desc, &batch), PLUMB_OK);
    return batch;
}

static void observe_gathers_what_getters_tell(void **state)
{
    (void)state;
    plumb_batch *batch = make();
    static const plumb_batch_joint_field fields[] = {
        PLUMB_JOINT_FIELD_VALUE,     PLUMB_JOINT_FIELD_RATE,   PLUMB_JOINT_FIELD_FORCE_X,
        PLUMB_JOINT_FIELD_FORCE_Y,   PLUMB_JOINT_FIELD_TORQUE, PLUMB_JOINT_FIELD_MOTOR_SPEED,
        PLUMB_JOINT_FIELD_MAX_MOTOR, PLUMB_JOINT_FIELD_REST
    };
    static const plumb_batch_joint_field drive[] = { PLUMB_JOINT_FIELD_MAX_MOTOR,
                                                     PLUMB_JOINT_FIELD_MOTOR_SPEED };
    plumb_real numbers[WORLDS * JOINTS * 8], speeds[WORLDS * 2];
    const plumb_batch_joint_view how = { joints, 1, drive, 2 };
    for (int w = 0; w < WORLDS; ++w) {
        speeds[2 * w] = 1000;
        speeds[2 * w + 1] = R(w - 5);
    }
    assert_int_equal(plumb_batch_drive_joints(batch, &how, speeds, WORLDS * 2), PLUMB_OK);
    assert_int_equal(plumb_batch_step(batch, DT, 30), PLUMB_OK);
    const plumb_batch_joint_view what = { joints, JOINTS, fields, 8 };
    assert_int_equal(plumb_batch_observe_joints(batch, &what, numbers, WORLDS * JOINTS * 8),
                     PLUMB_OK);
    for (uint32_t w = 0; w < WORLDS; ++w) {
        const plumb_world *world = plumb_batch_world(batch, w);
        for (uint32_t j = 0; j < JOINTS; ++j) {
            const plumb_real *n = &numbers[(w * JOINTS + j) * 8];
            assert_true(n[0] == plumb_joint_value(world, joints[j]));
            assert_true(n[1] == plumb_joint_rate(world, joints[j]));
            assert_true(n[2] == plumb_joint_force(world, joints[j]).x);
            assert_true(n[3] == plumb_joint_force(world, joints[j]).y);
            assert_true(n[4] == plumb_joint_torque(world, joints[j]));
        }
        assert_near(numbers[w * JOINTS * 8 + 1], (double)w - 5, 1e-3); // the motor's doing
        assert_near(numbers[w * JOINTS * 8 + 5], (double)w - 5, 0);
        assert_near(numbers[w * JOINTS * 8 + 6], 1000, 0);
        assert_near(numbers[w * JOINTS * 8 + 3], 9.81 * 3.14159 * (1 + 0.1 * w), 0.1);
    }
    plumb_batch_destroy(batch);
}

static void a_servo_goes_where_it_is_sent(void **state)
{
    (void)state;
    plumb_batch *batch = make();
    static const plumb_batch_joint_field rest[] = { PLUMB_JOINT_FIELD_REST };
    static const plumb_batch_joint_field value[] = { PLUMB_JOINT_FIELD_VALUE };
    const plumb_batch_joint_view how = { &joints[1], 1, rest, 1 },
                                 what = { &joints[1], 1, value, 1 };
    plumb_real targets[WORLDS], values[WORLDS];
    for (int w = 0; w < WORLDS; ++w) {
        targets[w] = R(0.1 * w - 1);
    }
    assert_int_equal(plumb_batch_drive_joints(batch, &how, targets, WORLDS), PLUMB_OK);
    assert_int_equal(plumb_batch_step(batch, DT, 180), PLUMB_OK);
    assert_int_equal(plumb_batch_observe_joints(batch, &what, values, WORLDS), PLUMB_OK);
    for (int w = 0; w < WORLDS; ++w) {
        assert_near(values[w], targets[w], 2e-3);
    }
    // What does not change wakes nobody.
    assert_int_equal(plumb_batch_step(batch, DT, 120), PLUMB_OK);
    plumb_world *first = plumb_batch_world(batch, 0);
    const uint32_t asleep = plumb_world_stats(first).asleep_count;
    assert_in_range(asleep, 1, 2);
    assert_int_equal(plumb_batch_drive_joints(batch, &how, targets, WORLDS), PLUMB_OK);
    assert_int_equal(plumb_batch_step(batch, DT, 1), PLUMB_OK);
    assert_int_equal(plumb_world_stats(first).asleep_count, asleep);
    plumb_batch_destroy(batch);
}

// A spring between two points: what is written is its length.
static void a_muscle_has_the_length_that_it_is_given(void **state)
{
    (void)state;
    plumb_batch *batch = make();
    plumb_joint muscle = PLUMB_NULL_INIT;
    for (int w = 0; w < WORLDS; ++w) {
        plumb_world *world = plumb_batch_world(batch, (uint32_t)w);
        muscle = plumb_joint_create(
            world, &(plumb_joint_desc){ .kind = PLUMB_DISTANCE,
                                        .body_b = plumb_body_create(world, &(plumb_body_desc){ 0 }),
                                        .anchor = { 0, 9 },
                                        .hertz = 3 });
    }
    static const plumb_batch_joint_field rest[] = { PLUMB_JOINT_FIELD_REST };
    const plumb_batch_joint_view how = { &muscle, 1, rest, 1 };
    plumb_real lengths[WORLDS];
    assert_int_equal(plumb_batch_observe_joints(batch, &how, lengths, WORLDS), PLUMB_OK);
    for (int w = 0; w < WORLDS; ++w) {
        assert_near(lengths[w], 9, ROUNDED(1e-5));
        lengths[w] = R(1 + w);
    }
    assert_int_equal(plumb_batch_drive_joints(batch, &how, lengths, WORLDS), PLUMB_OK);
    for (int w = 0; w < WORLDS; ++w) {
        plumb_joint_desc now;
        assert_int_equal(plumb_joint_settings(plumb_batch_world(batch, (uint32_t)w), muscle, &now),
                         PLUMB_OK);
        assert_near(now.length, 1 + w, 0);
    }
    plumb_batch_destroy(batch);
}

#define REFUSED_BY(code_, text, call)                                                              \
    do {                                                                                           \
        assert_int_equal(call, PLUMB_##code_);                                                     \
        assert_int_equal(plumb_batch_error(batch).code, PLUMB_##code_);                            \
        assert_string_equal(plumb_batch_error(batch).message, text);                               \
    } while (0)

static void views_are_checked(void **state)
{
    (void)state;
    plumb_batch *batch = make();
    static const plumb_batch_joint_field read[] = { PLUMB_JOINT_FIELD_VALUE };
    static const plumb_batch_joint_field twice[] = { PLUMB_JOINT_FIELD_REST,
                                                     PLUMB_JOINT_FIELD_REST };
    const plumb_batch_joint_field wrong[] = { (plumb_batch_joint_field)8 };
    plumb_real n[WORLDS * 4] = { 0 };
    const plumb_batch_joint_view ok = { joints, 2, read, 1 };
    assert_int_equal(plumb_batch_observe_joints(NULL, &ok, n, 46), PLUMB_E_NULL);
    assert_int_equal(plumb_batch_drive_joints(NULL, &ok, n, 46), PLUMB_E_NULL);
    REFUSED_BY(E_NULL, "plumb_batch_observe_joints: view is null; it must be given",
               plumb_batch_observe_joints(batch, NULL, n, 46));
    REFUSED_BY(E_NULL, "plumb_batch_observe_joints: numbers is null; it must be given",
               plumb_batch_observe_joints(batch, &ok, NULL, 46));
    REFUSED_BY(E_RANGE, "plumb_batch_observe_joints: capacity is 45; it must be at least 46",
               plumb_batch_observe_joints(batch, &ok, n, 45));
    REFUSED_BY(
        E_NULL, "plumb_batch_observe_joints: view.joints is null; it must be given",
        plumb_batch_observe_joints(batch, &(plumb_batch_joint_view){ NULL, 1, read, 1 }, n, 46));
    REFUSED_BY(
        E_NULL, "plumb_batch_observe_joints: view.fields is null; it must be given",
        plumb_batch_observe_joints(batch, &(plumb_batch_joint_view){ joints, 1, NULL, 1 }, n, 46));
    REFUSED_BY(E_RANGE,
               "plumb_batch_observe_joints: view.joint_count is 1048577; it must be 0 to 1048576",
               plumb_batch_observe_joints(
                   batch, &(plumb_batch_joint_view){ joints, 1048577, read, 1 }, n, 46));
    REFUSED_BY(
        E_RANGE, "plumb_batch_observe_joints: view.field_count is 65; it must be 0 to 64",
        plumb_batch_observe_joints(batch, &(plumb_batch_joint_view){ joints, 1, read, 65 }, n, 46));
    REFUSED_BY(
        E_RANGE, "plumb_batch_observe_joints: fields[0] is 8; it must be a field that can be read",
        plumb_batch_observe_joints(batch, &(plumb_batch_joint_view){ joints, 1, wrong, 1 }, n, 46));
    REFUSED_BY(E_RANGE,
               "plumb_batch_drive_joints: fields[0] is 0; it must be a field that can be written",
               plumb_batch_drive_joints(batch, &ok, n, 46));
    REFUSED_BY(
        E_DUPLICATE, "plumb_batch_drive_joints: fields[1] is 7 for the second time",
        plumb_batch_drive_joints(batch, &(plumb_batch_joint_view){ joints, 1, twice, 2 }, n, 46));
    plumb_batch_destroy(batch);
}

static void worlds_refuse_one_by_one(void **state)
{
    (void)state;
    plumb_batch *batch = make();
    static const plumb_batch_joint_field speed[] = { PLUMB_JOINT_FIELD_MAX_MOTOR };
    static const plumb_batch_joint_field value[] = { PLUMB_JOINT_FIELD_MAX_MOTOR };
    const plumb_batch_joint_view how = { joints, 1, speed, 1 }, what = { joints, 1, value, 1 };
    plumb_real most[WORLDS], seen[WORLDS];
    for (int w = 0; w < WORLDS; ++w) {
        most[w] = w == 7 ? -1 : R(w);
    }
    assert_int_equal(plumb_joint_destroy(plumb_batch_world(batch, 9), joints[0]), PLUMB_OK);
    assert_int_equal(plumb_batch_drive_joints(batch, &how, most, WORLDS), PLUMB_E_RANGE);
    assert_int_equal(plumb_batch_error(batch).world, 7);
    assert_int_equal(plumb_batch_error(batch).world_count, 2);
    assert_int_equal(plumb_batch_result(batch, 9), PLUMB_E_HANDLE);
    assert_int_equal(plumb_batch_observe_joints(batch, &what, seen, WORLDS), PLUMB_E_HANDLE);
    for (int w = 0; w < WORLDS; ++w) {
        assert_true(seen[w] == (w == 7 || w == 9 ? 0 : R(w)));
    }
    plumb_batch_destroy(batch);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(observe_gathers_what_getters_tell),
        cmocka_unit_test(a_servo_goes_where_it_is_sent),
        cmocka_unit_test(a_muscle_has_the_length_that_it_is_given),
        cmocka_unit_test(views_are_checked),
        cmocka_unit_test(worlds_refuse_one_by_one),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
