// test_api_joint.c - every function of joint.h: what it does, what it refuses and in which words.
#include "world_fixture.h"

#include <stdio.h>

#define NONE (plumb_joint) PLUMB_NULL_INIT

static plumb_joint make(fixture *f, plumb_joint_kind kind)
{
    plumb_joint_desc d = { .kind = kind, .body_a = f->fixed, .body_b = f->dynamic };
    if (kind == PLUMB_DISTANCE || kind == PLUMB_PULLEY || kind == PLUMB_CABLE) {
        d.anchor_b = plumb_v2(0, 5);
    }
    if (kind == PLUMB_PULLEY) {
        d.ground_a = plumb_v2(0, 8);
        d.ground_b = plumb_v2(0, 9);
    }
    d.pitch = kind == PLUMB_RATCHET ? 1 : 0;
    plumb_joint j = plumb_joint_create(f->world, &d);
    assert_false(plumb_is_null(j));
    return j;
}

static void every_kind_is_made_and_named(void **state)
{
    fixture *f = *state;
    const char *const names[] = {
#define NAME_ROW(NAME, name, text) #name,
        PLUMB_JOINT_LIST(NAME_ROW)
#undef NAME_ROW
    };
    int count = (int)(sizeof names / sizeof names[0]);
    for (int kind = 0; kind < count; ++kind) {
        plumb_joint j = make(f, (plumb_joint_kind)kind);
        assert_string_equal(plumb_joint_kind_name((plumb_joint_kind)kind), names[kind]);
        assert_true(plumb_joint_valid(f->world, j));
        assert_int_equal(plumb_joint_get_kind(f->world, j), kind);
        assert_int_equal(plumb_entity_get_kind(f->world, j.entity), PLUMB_KIND_JOINT);
        assert_true(plumb_same(plumb_joint_body_a(f->world, j), f->fixed));
        assert_true(plumb_same(plumb_joint_body_b(f->world, j), f->dynamic));
    }
    assert_null(plumb_joint_kind_name((plumb_joint_kind)count));
    assert_null(plumb_joint_kind_name((plumb_joint_kind)-1));
    plumb_joint all[32];
    assert_int_equal(plumb_world_joints(f->world, all, 32), count);
    assert_int_equal(plumb_joint_get_kind(f->world, all[1]), 1);
    assert_int_equal(plumb_world_joints(f->world, all, 2), count);
    assert_int_equal(plumb_body_joints(f->world, f->fixed, all, 32), count);
    assert_int_equal(plumb_joint_get_kind(f->world, all[0]), count - 1);
    assert_int_equal(plumb_body_joints(f->world, f->kinematic, all, 32), 0);
    assert_int_equal(plumb_world_step(f->world, R(0.01)), PLUMB_OK);
    assert_int_equal(f->errors, 0);
}

static void getters_tell_what_was_set(void **state)
{
    fixture *f = *state;
    plumb_world *w = f->world;
    int tag = 0;
    plumb_joint j = make(f, PLUMB_DISTANCE);
    plumb_joint_desc d;
    assert_int_equal(plumb_joint_settings(w, j, &d), PLUMB_OK);
    assert_near(d.length, 5, ROUNDED(1e-6));
    assert_near(plumb_joint_value(w, j), 5, ROUNDED(1e-6));
    assert_near(plumb_joint_error(w, j), 0, ROUNDED(1e-6));
    assert_vec_near(plumb_joint_anchor_a(w, j), 0, 0, ROUNDED(1e-6));
    assert_vec_near(plumb_joint_anchor_b(w, j), 0, 5, ROUNDED(1e-6));
    assert_int_equal(plumb_joint_set_limit(w, j, true, 1, 7), PLUMB_OK);
    assert_int_equal(plumb_joint_set_restitution(w, j, R(0.25)), PLUMB_OK);
    assert_int_equal(plumb_joint_set_spring(w, j, 2, R(0.5), 0), PLUMB_OK);
    assert_int_equal(plumb_joint_settings(w, j, &d), PLUMB_OK);
    assert_near(d.length, 5, ROUNDED(1e-6));
    assert_int_equal(plumb_joint_set_spring(w, j, 2, R(0.5), 3), PLUMB_OK);
    assert_int_equal(plumb_joint_set_break(w, j, 100, 200), PLUMB_OK);
    assert_int_equal(plumb_joint_set_user_data(w, j, &tag), PLUMB_OK);
    assert_int_equal(plumb_joint_settings(w, j, &d), PLUMB_OK);
    assert_true(d.enable_limit && d.lower == 1 && d.upper == 7 && d.hertz == 2);
    assert_true(d.length == 3 && d.rest == 0);
    assert_true(d.restitution == R(0.25) && !d.tell_impulse);
    assert_int_equal(plumb_joint_set_tell_impulse(w, j, true), PLUMB_OK);
    assert_int_equal(plumb_joint_settings(w, j, &d), PLUMB_OK);
    assert_true(d.tell_impulse);
    assert_vec_near(plumb_joint_impulse(w, j), 0, 0, 0);
    assert_near(plumb_joint_angular_impulse(w, j), 0, 0);
    assert_true(d.damping == R(0.5) && d.break_force == 100 && d.break_torque == 200);
    assert_ptr_equal(plumb_joint_user_data(w, j), &tag);
    assert_int_equal(plumb_joint_destroy(w, j), PLUMB_OK);

    j = make(f, PLUMB_REVOLUTE);
    assert_int_equal(plumb_joint_set_motor(w, j, true, 3, 4), PLUMB_OK);
    assert_int_equal(plumb_joint_settings(w, j, &d), PLUMB_OK);
    assert_true(d.enable_motor && d.motor_speed == 3 && d.max_motor == 4);
    plumb_body_teleport(w, f->dynamic, plumb_v2(0, 5), 1);
    assert_near(plumb_joint_value(w, j), 1, ROUNDED(1e-6));
    assert_int_equal(plumb_joint_destroy(w, j), PLUMB_OK);

    j = make(f, PLUMB_MOUSE);
    assert_int_equal(plumb_joint_settings(w, j, &d), PLUMB_OK);
    assert_true(d.hertz == 5 && d.damping == 1);
    assert_int_equal(plumb_joint_set_target(w, j, plumb_v2(3, 4)), PLUMB_OK);
    assert_vec_near(plumb_joint_anchor_a(w, j), 3, 4, ROUNDED(1e-6));
    assert_int_equal(plumb_joint_set_spring(w, j, 0, 0, 0), PLUMB_OK);
    assert_int_equal(plumb_joint_settings(w, j, &d), PLUMB_OK);
    assert_true(d.hertz == 5 && d.damping == 1);
    assert_int_equal(plumb_joint_set_stiffness(w, j, 30, 2, 0), PLUMB_OK);
    assert_int_equal(plumb_joint_settings(w, j, &d), PLUMB_OK);
    assert_true(d.stiffness == 30 && d.damper == 2 && d.hertz == 0 && d.damping == 0);
    assert_int_equal(plumb_joint_set_stiffness(w, j, 0, 0, 0), PLUMB_OK);
    assert_int_equal(plumb_joint_settings(w, j, &d), PLUMB_OK);
    assert_true(d.stiffness == 0 && d.damper == 0 && d.hertz == 5 && d.damping == 1);
    assert_int_equal(plumb_joint_destroy(w, j), PLUMB_OK);

    j = make(f, PLUMB_MOTOR);
    assert_int_equal(plumb_joint_set_target(w, j, plumb_v2(1, 0)), PLUMB_OK);
    assert_near(plumb_joint_error(w, j), 1, ROUNDED(1e-5));
    assert_int_equal(f->errors, 0);
}

static void mouse_and_motor_go_where_they_are_sent(void **state)
{
    fixture *f = *state;
    plumb_world *w = f->world;
    plumb_joint_desc d = { .kind = PLUMB_MOUSE, .body_b = f->dynamic, .anchor = { 0, 5 } };
    plumb_joint j = plumb_joint_create(w, &d);
    plumb_joint_set_target(w, j, plumb_v2(4, 7));
    for (int i = 0; i < 240; ++i) {
        plumb_world_step(w, R(1 / 60.0));
    }
    assert_near(plumb_body_position(w, f->dynamic).x, 4, 0.01);
    assert_near(plumb_body_position(w, f->dynamic).y, 7, 0.05); // the spring gives by g / w^2
    plumb_joint_destroy(w, j);
    d = (plumb_joint_desc){ .kind = PLUMB_MOTOR,
                            .body_b = f->dynamic,
                            .anchor = plumb_body_position(w, f->dynamic) };
    d.hertz = 2;
    d.damping = 1;
    d.rest = 1;
    j = plumb_joint_create(w, &d);
    plumb_joint_set_target(w, j, plumb_v2(-1, 0));
    for (int i = 0; i < 240; ++i) {
        plumb_world_step(w, R(1 / 60.0));
    }
    assert_near(plumb_body_position(w, f->dynamic).x, 3, 0.01);
    assert_near(plumb_joint_value(w, j), 1, 0.01);
}

static void bad_handles_give_zeros(void **state)
{
    fixture *f = *state;
    const plumb_world *w = f->world;
    const plumb_joint bad[] = { NONE, { f->dynamic.entity }, { f->stale.entity } };
    for (int i = 0; i < 3; ++i) {
        assert_false(plumb_joint_valid(w, bad[i]));
        assert_int_equal(plumb_joint_get_kind(w, bad[i]), 0);
        assert_true(plumb_is_null(plumb_joint_body_a(w, bad[i])));
        assert_true(plumb_is_null(plumb_joint_body_b(w, bad[i])));
        assert_vec_near(plumb_joint_anchor_a(w, bad[i]), 0, 0, 0);
        assert_vec_near(plumb_joint_anchor_b(w, bad[i]), 0, 0, 0);
        assert_vec_near(plumb_joint_force(w, bad[i]), 0, 0, 0);
        assert_near(plumb_joint_torque(w, bad[i]), 0, 0);
        assert_near(plumb_joint_value(w, bad[i]), 0, 0);
        assert_near(plumb_joint_error(w, bad[i]), 0, 0);
        assert_null(plumb_joint_user_data(w, bad[i]));
    }
    int count = 7;
    assert_null(plumb_world_joint_break_events(NULL, &count));
    assert_int_equal(count, 0);
    assert_int_equal(plumb_world_joints(NULL, NULL, 0), 0);
    assert_int_equal(plumb_body_joints(NULL, NO_BODY, NULL, 0), 0);
    assert_true(plumb_is_null(plumb_joint_create(NULL, NULL)));
    assert_int_equal(plumb_joint_destroy(NULL, NONE), PLUMB_E_NULL);
    assert_int_equal(plumb_joint_settings(NULL, NONE, NULL), PLUMB_E_NULL);
    assert_int_equal(plumb_joint_set_limit(NULL, NONE, false, 0, 0), PLUMB_E_NULL);
}

#define REFUSED_JOINT(code, message, ...)                                                          \
    do {                                                                                           \
        const plumb_joint_desc desc_ = { __VA_ARGS__ };                                            \
        REFUSED(code, "plumb_joint_create: " message,                                              \
                made(f->world, plumb_joint_create(f->world, &desc_)));                             \
    } while (0)

static void descriptors_are_checked(void **state)
{
    fixture *f = *state;
    plumb_body b = f->dynamic;
    REFUSED(E_NULL, "plumb_joint_create: desc is null; it must be given",
            made(f->world, plumb_joint_create(f->world, NULL)));
    REFUSED_JOINT(E_RANGE, "kind is 99; it must be a plumb_joint_kind",
                  .kind = (plumb_joint_kind)99);
    REFUSED_JOINT(E_HANDLE, "body_b is null as body_a is; it must be another", .kind = PLUMB_WELD);
    REFUSED_JOINT(E_HANDLE, "body_b is body_a; it must be another", .body_a = b, .body_b = b);
    REFUSED_JOINT(E_HANDLE, "body_a is a shape; it must be a live body or null",
                  .body_a = (plumb_body){ f->box.entity });
    REFUSED_JOINT(E_NOT_FINITE, "anchor is (nan, 0); it must be finite", .body_b = b,
                  .anchor = { (plumb_real)NAN, 0 });
    REFUSED_JOINT(E_RANGE, "anchor_b is (0, 2e+09); each component must be -1e+09 to 1e+09",
                  .body_b = b, .anchor_b = { 0, R(2e9) });
    REFUSED_JOINT(E_RANGE, "upper is 1; it must be at least 2", .body_b = b, .lower = 2,
                  .upper = 1);
    REFUSED_JOINT(E_NOT_FINITE, "motor_speed is inf; it must be finite", .body_b = b,
                  .motor_speed = (plumb_real)INFINITY);
    REFUSED_JOINT(E_RANGE, "max_motor is -1; it must be at least 0", .body_b = b, .max_motor = -1);
    REFUSED_JOINT(E_RANGE, "hertz is -1; it must be at least 0", .body_b = b, .hertz = -1);
    REFUSED_JOINT(E_RANGE, "damping is -1; it must be at least 0", .body_b = b, .damping = -1);
    REFUSED_JOINT(E_RANGE, "break_force is -1; it must be at least 0", .body_b = b,
                  .break_force = -1);
    REFUSED_JOINT(E_RANGE, "enable_limit is set; it must be 0 for a weld joint", PLUMB_WELD,
                  .body_b = b, .enable_limit = true);
    REFUSED_JOINT(E_RANGE, "enable_motor is set; it must be 0 for a gear joint", PLUMB_GEAR,
                  .body_b = b, .enable_motor = true);
    REFUSED_JOINT(E_RANGE, "stiffness is -1; it must be at least 0", .body_b = b, .stiffness = -1);
    REFUSED_JOINT(E_RANGE, "restitution is -1; it must be 0 to 1", .body_b = b, .restitution = -1);
    REFUSED_JOINT(E_RANGE, "restitution is 1.5; it must be 0 to 1", .body_b = b,
                  .restitution = R(1.5));
    REFUSED_JOINT(E_NOT_FINITE, "restitution is nan; it must be finite", .body_b = b,
                  .restitution = (plumb_real)NAN);
    REFUSED_JOINT(E_RANGE, "damper is -1; it must be at least 0", .body_b = b, .damper = -1);
    REFUSED_JOINT(E_RANGE,
                  "stiffness is set with hertz; a spring has either hertz and damping, or "
                  "stiffness and damper",
                  .body_b = b, .hertz = 1, .stiffness = 2);
    REFUSED_JOINT(E_RANGE,
                  "damper is set with damping; a spring has either hertz and damping, or stiffness "
                  "and damper",
                  .body_b = b, .damping = 1, .damper = 2);
    REFUSED_JOINT(E_RANGE, "hertz is set; it must be 0 for a pulley joint", PLUMB_PULLEY,
                  .body_b = b, .hertz = 1);
    REFUSED_JOINT(E_NOT_FINITE, "axis is (nan, 0); it must be finite", PLUMB_PRISMATIC, .body_b = b,
                  .axis = { (plumb_real)NAN, 0 });
    REFUSED_JOINT(E_GEOMETRY, "length is 0; a rod must have length (use a revolute joint)",
                  PLUMB_DISTANCE, .body_b = b);
    REFUSED_JOINT(E_RANGE, "lower is -1; it must be at least 0", PLUMB_DISTANCE, .body_b = b,
                  .enable_limit = true, .lower = -1);
    REFUSED_JOINT(E_RANGE, "ratio is -1; it must be above 0, or 0 for 1", PLUMB_PULLEY, .body_b = b,
                  .ratio = -1);
    REFUSED_JOINT(E_GEOMETRY, "ground_a is the anchor; the rope must have length on both sides",
                  PLUMB_PULLEY, .body_b = b);
    REFUSED_JOINT(E_GEOMETRY, "ground_b is the anchor; the rope must have length on both sides",
                  PLUMB_PULLEY, .body_b = b, .ground_a = { 0, 1 });
    REFUSED_JOINT(E_GEOMETRY,
                  "anchors are 0 m apart; no rope touches both rims unless it is more than 0",
                  PLUMB_CABLE, .body_b = b);
    REFUSED_JOINT(
        E_GEOMETRY, "anchors are 1 m apart; no rope touches both rims unless it is more than 1.5",
        PLUMB_CABLE, .body_b = b, .anchor_b = { 0, 1 }, .radius_a = 1, .radius_b = R(-0.5));
    REFUSED_JOINT(E_RANGE, "length is -1; it must be at least 0", PLUMB_CABLE, .body_b = b,
                  .anchor_b = { 0, 1 }, .length = -1);
    REFUSED_JOINT(E_NOT_FINITE, "radius_b is nan; it must be finite", PLUMB_CABLE, .body_b = b,
                  .anchor_b = { 0, 1 }, .radius_b = NAN);
    REFUSED_JOINT(E_RANGE, "pitch is 0; a ratchet must have teeth", PLUMB_RATCHET, .body_b = b);
    assert_int_equal(plumb_world_joints(f->world, NULL, 0), 0);
}

// Sets the member of one of a descriptor's numbers, points or switches.
typedef struct member {
    const char *name;
    size_t offset;
    bool is_switch;
    const char *kinds; // that have it, by their first letters below
} member;

#define MEMBER(name, kinds)                                                                        \
    {                                                                                              \
#name, offsetof(plumb_joint_desc, name), false, kinds                                      \
    }
#define SWITCH(name, kinds)                                                                        \
    {                                                                                              \
#name, offsetof(plumb_joint_desc, name), true, kinds                                       \
    }

// What joint.h says of each member, kind by kind.
static void members_that_a_kind_does_not_have_are_refused(void **state)
{
    fixture *f = *state;
    // revolute prismatic weld wheel distance mouse motor gear pulley ratchet friction cable
    static const char letters[] = "rpwhdmogyafc";
    static const member members[] = {
        MEMBER(anchor_b, "dyc"),     MEMBER(ground_a, "y"),        MEMBER(ground_b, "y"),
        MEMBER(axis, "phg"),         SWITCH(enable_limit, "rphd"), MEMBER(upper, "rphd"),
        SWITCH(enable_motor, "rph"), MEMBER(motor_speed, "rph"),   MEMBER(max_motor, "rph"),
        MEMBER(hertz, "rpwhdmo"),    MEMBER(damping, "rpwhdmo"),   MEMBER(rest, "rpwho"),
        MEMBER(restitution, "rphd"), MEMBER(stiffness, "rpwhdmo"), MEMBER(damper, "rpwhdmo"),
        MEMBER(length, "dc"),        MEMBER(ratio, "gy"),          MEMBER(pitch, "a"),
        MEMBER(max_force, "mof"),    MEMBER(max_torque, "of"),     MEMBER(radius_a, "c"),
        MEMBER(radius_b, "c"),
    };
    for (int kind = 0; kind <= PLUMB_CABLE; ++kind) {
        for (size_t i = 0; i < sizeof members / sizeof members[0]; ++i) {
            plumb_joint_desc d = { .kind = (plumb_joint_kind)kind, .body_b = f->dynamic };
            d.anchor = plumb_v2(0, 5);
            d.ground_a = d.ground_b = kind == PLUMB_PULLEY ? plumb_v2(0, 9) : plumb_v2(0, 0);
            d.pitch = kind == PLUMB_RATCHET ? 1 : 0;
            const plumb_real one = 1;
            if (members[i].is_switch) {
                *(bool *)((char *)&d + members[i].offset) = true;
            } else {
                memcpy((char *)&d + members[i].offset, &one, sizeof one);
            }
            char wanted[128];
            snprintf(wanted, sizeof wanted,
                     "plumb_joint_create: %s is set; it must be 0 for a %s joint", members[i].name,
                     plumb_joint_kind_name((plumb_joint_kind)kind));
            plumb_joint j = plumb_joint_create(f->world, &d);
            bool has = strchr(members[i].kinds, letters[kind]) != NULL;
            if (plumb_is_null(j) == has || (!has && strcmp(f->logged, wanted) != 0)) {
                fail_msg("%s: %s", wanted, f->logged);
            }
        }
    }
}

static void members_that_do_nothing_are_warned_of(void **state)
{
    fixture *f = *state;
    const plumb_joint_desc cases[] = {
        { .upper = 1 },
        { .lower = -1 },
        { .motor_speed = 1 },
        { .max_motor = 1 },
        { .enable_motor = true, .motor_speed = 1 },
    };
    for (int i = 0; i < 5; ++i) {
        plumb_joint_desc d = cases[i];
        d.body_b = f->dynamic;
        assert_false(plumb_is_null(plumb_joint_create(f->world, &d)));
        assert_int_equal(f->warnings, i + 1);
    }
    plumb_joint_desc meant = { .body_b = f->dynamic, .enable_limit = true, .upper = 1 };
    meant.enable_motor = true;
    meant.max_motor = 1;
    plumb_joint j = plumb_joint_create(f->world, &meant);
    assert_int_equal(f->warnings, 5);
    assert_int_equal(plumb_joint_set_motor(f->world, j, true, 1, 0), PLUMB_OK);
    assert_int_equal(f->warnings, 6);
    assert_string_equal(f->logged, "plumb_joint_set_motor: max_motor is 0; the motor does nothing");
    assert_int_equal(plumb_joint_set_motor(f->world, j, false, 1, 0), PLUMB_OK);
    assert_int_equal(plumb_joint_set_limit(f->world, j, false, 0, 1), PLUMB_OK);
    assert_int_equal(f->warnings, 6);
    assert_int_equal(f->errors, 0);
}

static void setters_refuse(void **state)
{
    fixture *f = *state;
    plumb_world *w = f->world;
    plumb_joint weld = make(f, PLUMB_WELD), rod = make(f, PLUMB_DISTANCE);
    REFUSED(E_HANDLE, "plumb_joint_destroy: joint is null; it must be a live joint",
            plumb_joint_destroy(w, NONE));
    REFUSED(E_HANDLE, "plumb_joint_set_break: joint is a body; it must be a live joint",
            plumb_joint_set_break(w, (plumb_joint){ f->dynamic.entity }, 0, 0));
    REFUSED(E_HANDLE, "plumb_joint_settings: joint is null; it must be a live joint",
            plumb_joint_settings(w, NONE, NULL));
    REFUSED(E_NULL, "plumb_joint_settings: desc is null; it must be given",
            plumb_joint_settings(w, weld, NULL));
    REFUSED(E_HANDLE, "plumb_body_set_gravity_scale: body is a joint; it must be a live body",
            plumb_body_set_gravity_scale(w, (plumb_body){ weld.entity }, 1));
    REFUSED(E_STATE, "plumb_joint_set_limit: joint is a weld joint; it must be one with a limit",
            plumb_joint_set_limit(w, weld, true, 0, 1));
    REFUSED(E_STATE, "plumb_joint_set_motor: joint is a weld joint; it must be one with a motor",
            plumb_joint_set_motor(w, weld, true, 0, 1));
    REFUSED(E_STATE, "plumb_joint_set_target: joint is a weld joint; it must be one with a target",
            plumb_joint_set_target(w, weld, plumb_v2(0, 0)));
    plumb_joint gear = make(f, PLUMB_GEAR), mouse = make(f, PLUMB_MOUSE);
    plumb_joint hinge = make(f, PLUMB_REVOLUTE);
    REFUSED(E_STATE, "plumb_joint_set_spring: joint is a gear joint; it must be one with a spring",
            plumb_joint_set_spring(w, gear, 1, 0, 0));
    REFUSED(E_RANGE, "plumb_joint_set_limit: lower is -1; it must be at least 0",
            plumb_joint_set_limit(w, rod, true, -1, 1));
    REFUSED(E_RANGE, "plumb_joint_set_limit: upper is 0.5; it must be at least 1",
            plumb_joint_set_limit(w, rod, true, 1, R(0.5)));
    REFUSED(E_NOT_FINITE, "plumb_joint_set_motor: speed is nan; it must be finite",
            plumb_joint_set_motor(w, hinge, true, (plumb_real)NAN, 0));
    REFUSED(E_RANGE, "plumb_joint_set_motor: max_motor is -1; it must be at least 0",
            plumb_joint_set_motor(w, hinge, true, 0, -1));
    REFUSED(E_RANGE, "plumb_joint_set_spring: hertz is -1; it must be at least 0",
            plumb_joint_set_spring(w, rod, -1, 0, 0));
    REFUSED(E_RANGE, "plumb_joint_set_spring: damping is -1; it must be at least 0",
            plumb_joint_set_spring(w, rod, 1, -1, 0));
    REFUSED(E_NOT_FINITE, "plumb_joint_set_spring: rest is nan; it must be finite",
            plumb_joint_set_spring(w, rod, 1, 0, (plumb_real)NAN));
    REFUSED(E_RANGE, "plumb_joint_set_spring: rest is -1; it must be at least 0",
            plumb_joint_set_spring(w, rod, 1, 0, -1));
    REFUSED(E_RANGE, "plumb_joint_set_stiffness: rest is 2; it must be 0 for a mouse joint",
            plumb_joint_set_stiffness(w, mouse, 1, 0, 2));
    REFUSED(E_HANDLE, "plumb_joint_set_tell_impulse: joint is null; it must be a live joint",
            plumb_joint_set_tell_impulse(w, NONE, true));
    REFUSED(E_STATE,
            "plumb_joint_set_restitution: joint is a gear joint; it must be one with a limit",
            plumb_joint_set_restitution(w, gear, 1));
    REFUSED(E_RANGE, "plumb_joint_set_restitution: restitution is 2; it must be 0 to 1",
            plumb_joint_set_restitution(w, rod, 2));
    REFUSED(E_STATE,
            "plumb_joint_set_stiffness: joint is a gear joint; it must be one with a spring",
            plumb_joint_set_stiffness(w, gear, 1, 0, 0));
    REFUSED(E_RANGE, "plumb_joint_set_stiffness: stiffness is -1; it must be at least 0",
            plumb_joint_set_stiffness(w, rod, -1, 0, 0));
    REFUSED(E_RANGE, "plumb_joint_set_stiffness: damper is -1; it must be at least 0",
            plumb_joint_set_stiffness(w, rod, 1, -1, 0));
    REFUSED(E_NOT_FINITE, "plumb_joint_set_stiffness: stiffness is inf; it must be finite",
            plumb_joint_set_stiffness(w, rod, (plumb_real)INFINITY, 0, 0));
    REFUSED(E_NOT_FINITE, "plumb_joint_set_stiffness: rest is nan; it must be finite",
            plumb_joint_set_stiffness(w, rod, 1, 0, (plumb_real)NAN));
    REFUSED(E_NOT_FINITE, "plumb_joint_set_target: target is (0, nan); it must be finite",
            plumb_joint_set_target(w, mouse, plumb_v2(0, (plumb_real)NAN)));
    REFUSED(E_RANGE, "plumb_joint_set_break: force is -1; it must be at least 0",
            plumb_joint_set_break(w, rod, -1, 0));
    REFUSED(E_HANDLE, "plumb_joint_set_user_data: joint is null; it must be a live joint",
            plumb_joint_set_user_data(w, NONE, NULL));
}

static void try_in_a_step(const plumb_system_call *call)
{
    plumb_joint joints[1];
    plumb_joint_desc d = { 0 };
    plumb_world_joints(call->world, joints, 1);
    assert_true(plumb_is_null(plumb_joint_create(call->world, &d)));
    assert_string_equal(plumb_world_error(call->world).message,
                        "plumb_joint_create: the world is stepping (system 'meddle'); call it "
                        "between steps");
    assert_int_equal(plumb_joint_destroy(call->world, joints[0]), PLUMB_E_LOCKED);
    assert_string_equal(plumb_world_error(call->world).message,
                        "plumb_joint_destroy: the world is stepping (system 'meddle'); use "
                        "plumb_command_destroy");
    plumb_joint_memory memory = { .turns_a = 1 };
    assert_int_equal(plumb_joint_set_memory(call->world, joints[0], &memory), PLUMB_E_LOCKED);
    assert_int_equal(plumb_command_destroy(call->world, joints[0].entity), PLUMB_OK);
}

static void joints_are_locked_in_a_step(void **state)
{
    fixture *f = *state;
    plumb_joint j = make(f, PLUMB_WELD);
    const plumb_system_desc meddle = { .name = "meddle", .run = try_in_a_step };
    assert_int_equal(plumb_system_create(f->world, &meddle), PLUMB_OK);
    assert_int_equal(plumb_world_step(f->world, R(0.01)), PLUMB_OK);
    assert_true(plumb_joint_valid(f->world, j));
    assert_int_equal(plumb_commands_apply(f->world), PLUMB_OK);
    assert_false(plumb_joint_valid(f->world, j));
}

static void joints_go_with_their_bodies(void **state)
{
    fixture *f = *state;
    plumb_joint j = make(f, PLUMB_WELD), k = make(f, PLUMB_REVOLUTE);
    int value = 1;
    plumb_component tag = plumb_component_create(
        f->world, &(plumb_component_desc){ .name = "tag", .size = sizeof value });
    assert_int_equal(plumb_component_set(f->world, j.entity, tag, &value), PLUMB_OK);
    assert_int_equal(plumb_body_destroy(f->world, f->dynamic), PLUMB_OK);
    assert_false(plumb_joint_valid(f->world, j));
    assert_false(plumb_joint_valid(f->world, k));
    assert_int_equal(plumb_world_column(f->world, tag).count, 0);
    assert_int_equal(plumb_body_joints(f->world, f->fixed, NULL, 0), 0);
    assert_int_equal(plumb_world_step(f->world, R(0.01)), PLUMB_OK);
}

// A rod that a blow of 12 N s loads: it breaks by 10 N s, not by 15 N s, and by no force.
static void joints_break_by_impulse(void **state)
{
    (void)state;
    const plumb_solver solvers[] = { PLUMB_SOLVER_SOFT, PLUMB_SOLVER_PGS, PLUMB_SOLVER_EXACT };
    for (int k = 0; k < 4; ++k) {
        plumb_world *w = NULL;
        plumb_world_create(&(plumb_world_desc){ .zero_gravity = true, .solver = solvers[k / 2] },
                           &w);
        plumb_body b = plumb_body_create(w, &(plumb_body_desc){ .mass = 2, .inertia = 1 });
        plumb_joint j = plumb_joint_create(w, &(plumb_joint_desc){ .body_b = b });
        plumb_real bound = k % 2 == 0 ? 10 : 15;
        assert_int_equal(plumb_joint_set_break_impulse(w, j, bound), PLUMB_OK);
        plumb_joint_desc d;
        plumb_joint_settings(w, j, &d);
        assert_near(d.break_impulse, bound, 0);
        for (int i = 0; i < 30; ++i) {
            assert_int_equal(plumb_world_step(w, R(1.0 / 60)), PLUMB_OK);
        }
        assert_true(plumb_joint_valid(w, j));
        plumb_body_apply_impulse_center(w, b, plumb_v2(12, 0));
        assert_int_equal(plumb_world_step(w, R(1.0 / 60)), PLUMB_OK);
        int count;
        const plumb_joint_break *e = plumb_world_joint_break_events(w, &count);
        assert_int_equal(count, k % 2 == 0 ? 1 : 0);
        assert_int_equal(plumb_joint_valid(w, j), k % 2 != 0);
        if (count > 0) {
            assert_true(plumb_same(e->joint, j));
            assert_near(plumb_vec2_magnitude(e->impulse), 12, 0.5);
        }
        plumb_world_destroy(w);
    }
}

static void a_joint_that_is_off_does_nothing(void **state)
{
    fixture *f = *state;
    plumb_world *w = f->world;
    plumb_joint_desc d = { .kind = PLUMB_WELD, .body_b = f->dynamic, .anchor = { 0, 5 } };
    d.disabled = true;
    plumb_joint j = plumb_joint_create(w, &d);
    assert_true(plumb_joint_valid(w, j));
    assert_false(plumb_joint_is_enabled(w, j));
    for (int i = 0; i < 10; ++i) {
        plumb_world_step(w, R(0.01));
    }
    plumb_real y = plumb_body_position(w, f->dynamic).y;
    assert_true(y < R(4.97));
    assert_vec_near(plumb_joint_force(w, j), 0, 0, 0);
    assert_int_equal(plumb_joint_set_enabled(w, j, true), PLUMB_OK);
    assert_true(plumb_joint_is_enabled(w, j));
    for (int i = 0; i < 200; ++i) {
        plumb_world_step(w, R(0.01));
    }
    assert_near(plumb_body_position(w, f->dynamic).y, 5, 0.01);
    assert_near(plumb_joint_force(w, j).y, 4 * 9.81, ROUNDED(0.1));
    assert_int_equal(plumb_joint_set_enabled(w, j, false), PLUMB_OK);
    plumb_world_step(w, R(0.01));
    assert_vec_near(plumb_joint_force(w, j), 0, 0, 0);
    assert_near(plumb_joint_torque(w, j), 0, 0);
    assert_false(plumb_joint_is_enabled(w, NONE));
}

// Joined bodies do not collide; with the joint off, they do.
static void a_joint_that_is_off_keeps_nobody_apart(void **state)
{
    fixture *f = *state;
    plumb_world *w = f->world;
    plumb_body_teleport(w, f->dynamic, plumb_v2(0, 2), 0);
    plumb_joint j = plumb_joint_create(
        w, &(plumb_joint_desc){ .kind = PLUMB_FRICTION, .body_a = f->fixed, .body_b = f->dynamic });
    plumb_joint_set_enabled(w, j, false);
    for (int i = 0; i < 60; ++i) {
        plumb_world_step(w, R(1.0 / 60));
    }
    assert_near(plumb_body_position(w, f->dynamic).y, 2, 0.01);
    plumb_joint_set_enabled(w, j, true);
    for (int i = 0; i < 30; ++i) {
        plumb_world_step(w, R(1.0 / 60));
    }
    assert_true(plumb_body_position(w, f->dynamic).y < R(1.5));
}

static void impulse_and_enabling_are_refused(void **state)
{
    fixture *f = *state;
    plumb_world *w = f->world;
    plumb_joint j = make(f, PLUMB_REVOLUTE);
    REFUSED(E_RANGE, "plumb_joint_set_break_impulse: impulse is -1; it must be at least 0",
            plumb_joint_set_break_impulse(w, j, -1));
    REFUSED(E_HANDLE, "plumb_joint_set_break_impulse: joint is null; it must be a live joint",
            plumb_joint_set_break_impulse(w, NONE, 1));
    REFUSED(E_HANDLE, "plumb_joint_set_enabled: joint is a body; it must be a live joint",
            plumb_joint_set_enabled(w, (plumb_joint){ f->dynamic.entity }, true));
    REFUSED(E_RANGE, "plumb_joint_create: break_impulse is -1; it must be at least 0",
            made(w, plumb_joint_create(
                        w, &(plumb_joint_desc){ .body_b = f->dynamic, .break_impulse = -1 })));
}

// A world with joints and no shapes has a solver; without joints it has none.
static void schedule_follows_joints(void **state)
{
    (void)state;
    plumb_world *w = NULL;
    assert_int_equal(plumb_world_create(NULL, &w), PLUMB_OK);
    plumb_body b = plumb_body_create(w, &(plumb_body_desc){ .position = { 1, 0 } });
    plumb_joint j = PLUMB_NULL_INIT;
    for (int with = 0; with < 2; ++with) {
        if (with == 1) {
            j = plumb_joint_create(w, &(plumb_joint_desc){ .body_b = b, .anchor = { 0, 0 } });
        }
        assert_int_equal(plumb_world_step(w, R(0.01)), PLUMB_OK);
        plumb_pass_info rows[128];
        int count = plumb_world_schedule(w, rows, 128), found = 0;
        for (int i = 0; i < count; ++i) {
            bool joint_pass =
                strcmp(rows[i].name, "graph") == 0 || strcmp(rows[i].name, "soft step") == 0 ||
                strcmp(rows[i].name, "joints") == 0 || strcmp(rows[i].name, "reactions") == 0;
            found += joint_pass;
            assert_true(!joint_pass || rows[i].scheduled == (with == 1));
            assert_true(strcmp(rows[i].name, "narrow phase") != 0 || !rows[i].scheduled);
        }
        assert_int_equal(found, 4);
    }
    assert_near(plumb_joint_error(w, j), 0, 0.01);
    plumb_world_destroy(w);
}

// A wheel driven for some turns is made anew from its memory: its coordinate, and what it does next,
// are those of the first one.
static void memory_carries_a_joint_over(void **state)
{
    fixture *f = *state;
    plumb_world *w = f->world;
    plumb_joint_desc d = { .kind = PLUMB_REVOLUTE,
                           .body_b = f->dynamic,
                           .enable_motor = true,
                           .motor_speed = 9,
                           .max_motor = 1e6f };
    d.anchor = plumb_body_center(w, f->dynamic);
    plumb_joint j = plumb_joint_create(w, &d);
    for (int i = 0; i < 120; ++i) {
        assert_int_equal(plumb_world_step(w, R(1.0 / 60)), PLUMB_OK);
    }
    plumb_joint_memory m;
    assert_int_equal(plumb_joint_get_memory(w, j, &m), PLUMB_OK);
    assert_int_equal(m.turns_b, 3); // 18 rad
    assert_true(m.substep > 0);
    plumb_real value = plumb_joint_value(w, j);
    assert_int_equal(plumb_joint_destroy(w, j), PLUMB_OK);
    plumb_joint again = plumb_joint_create(w, &d);
    assert_near(plumb_joint_value(w, again), 0, ROUNDED(1e-6));
    assert_int_equal(plumb_joint_set_memory(w, again, &m), PLUMB_OK);
    assert_true(plumb_joint_value(w, again) == value);
    plumb_joint_memory n;
    assert_int_equal(plumb_joint_get_memory(w, again, &n), PLUMB_OK);
    assert_memory_equal(&n, &m, sizeof m);
    assert_int_equal(plumb_world_step(w, R(1.0 / 60)), PLUMB_OK);
    assert_near(plumb_joint_value(w, again), (double)value + 9.0 / 60, ROUNDED(1e-3));
}

static void memory_refuses(void **state)
{
    fixture *f = *state;
    plumb_world *w = f->world;
    plumb_joint j = make(f, PLUMB_PRISMATIC);
    plumb_joint_memory m, good;
    assert_int_equal(plumb_joint_get_memory(w, j, &good), PLUMB_OK);
    assert_int_equal(plumb_joint_get_memory(NULL, j, &m), PLUMB_E_NULL);
    assert_int_equal(plumb_joint_get_memory(w, j, NULL), PLUMB_E_NULL);
    assert_int_equal(plumb_joint_get_memory(w, NONE, &m), PLUMB_E_HANDLE);
    assert_int_equal(plumb_joint_set_memory(NULL, j, &good), PLUMB_E_NULL);
    assert_int_equal(plumb_joint_set_memory(w, j, NULL), PLUMB_E_NULL);
    assert_int_equal(plumb_joint_set_memory(w, (plumb_joint){ f->dynamic.entity }, &good),
                     PLUMB_E_HANDLE);
    plumb_real *const numbers[] = { &m.anchor_a.x, &m.anchor_b.y, &m.axis.x,
                                    &m.offset.y,   &m.start_a,    &m.start_b,
                                    &m.kept,       &m.substep,    &m.impulses[5] };
    for (size_t i = 0; i < sizeof numbers / sizeof numbers[0]; ++i) {
        m = good;
        *numbers[i] = (plumb_real)NAN;
        assert_int_equal(plumb_joint_set_memory(w, j, &m), PLUMB_E_NOT_FINITE);
    }
    m = good, m.anchor_a.x = R(2e9);
    assert_int_equal(plumb_joint_set_memory(w, j, &m), PLUMB_E_RANGE);
    m = good, m.substep = R(-0.1);
    assert_int_equal(plumb_joint_set_memory(w, j, &m), PLUMB_E_RANGE);
    m = good, m.axis = plumb_v2(3, 4);
    assert_int_equal(plumb_joint_set_memory(w, j, &m), PLUMB_E_RANGE);
    assert_non_null(
        strstr(plumb_world_error(w).message,
               "plumb_joint_set_memory: axis is (3, 4); it must have length 1, or be 0"));
    assert_int_equal(plumb_joint_get_memory(w, j, &m), PLUMB_OK);
    assert_memory_equal(&m, &good, sizeof m); // as it was
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        API_TEST(every_kind_is_made_and_named),
        API_TEST(getters_tell_what_was_set),
        API_TEST(mouse_and_motor_go_where_they_are_sent),
        API_TEST(bad_handles_give_zeros),
        API_TEST(descriptors_are_checked),
        API_TEST(members_that_a_kind_does_not_have_are_refused),
        API_TEST(members_that_do_nothing_are_warned_of),
        API_TEST(setters_refuse),
        API_TEST(joints_are_locked_in_a_step),
        API_TEST(joints_go_with_their_bodies),
        cmocka_unit_test(joints_break_by_impulse),
        API_TEST(a_joint_that_is_off_does_nothing),
        API_TEST(a_joint_that_is_off_keeps_nobody_apart),
        API_TEST(impulse_and_enabling_are_refused),
        API_TEST(memory_carries_a_joint_over),
        API_TEST(memory_refuses),
        cmocka_unit_test(schedule_follows_joints),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
