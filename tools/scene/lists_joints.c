// lists_joints.c - the keys of the joint constructors, one array of rows a kind. PLUMB_JOINT_LIST
// is the list of kinds: one added there has GENERAL_ROWS, until <name>_rows here say what it has more exactly, or
// what no other kind has, which is then for joints.c. What all kinds have is said by the schema.
#include <string.h>

#include "lists.h"

// clang-format off
#define T sc_motor
static const sc_field drive_rows[] = {
    { "force",  SC_NUMBER, AT(T, force),  0, BIG, "N", 0, 0 },
    { "speed",  SC_NUMBER, AT(T, speed),  -BIG, BIG, "rad/s or m/s", 0, SC_REQUIRED },
    { "torque", SC_NUMBER, AT(T, torque), 0, BIG, "N m", 0, 0 },
};
const sc_list sc_list_motor = { "motor", drive_rows, COUNT(drive_rows) };
#undef T

#define T sc_spring
static const sc_field spring_rows[] = {
    { "damper",    SC_NUMBER, AT(T, damper),    0, BIG, "N s/m or N m s/rad", 0, 0 },
    { "damping",   SC_NUMBER, AT(T, damping),   0, 1e6, "1", 0, 0 },
    { "frequency", SC_NUMBER, AT(T, frequency), 0, 1e6, "1/s", 0, SC_ABOVE },
    { "rest",      SC_NUMBER, AT(T, rest),      -BIG, BIG, "rad or m", 0, 0 },
    { "stiffness", SC_NUMBER, AT(T, stiffness), 0, BIG, "N/m or N m/rad", 0, 0 },
};
const sc_list sc_list_spring = { "spring", spring_rows, COUNT(spring_rows) };
#undef T

#define T sc_joint_state
static const sc_field state_rows[] = {
    { "anchor_a", SC_VEC2,    AT(T, anchor_a), -FAR, FAR, "m", 0, SC_REQUIRED },
    { "anchor_b", SC_VEC2,    AT(T, anchor_b), -FAR, FAR, "m", 0, SC_REQUIRED },
    { "axis",     SC_VEC2,    AT(T, axis),     -1.001, 1.001, "1", 0, SC_REQUIRED },
    { "impulses", SC_NUMBERS, AT(T, impulses), -1e30, 1e30, "N s", 0, SC_REQUIRED },
    { "kept",     SC_NUMBER,  AT(T, kept),     -BIG, BIG, "rad or m", 0, SC_REQUIRED },
    { "offset",   SC_VEC2,    AT(T, offset),   -FAR, FAR, "m", 0, SC_REQUIRED },
    { "start",    SC_VEC2,    AT(T, start),    -BIG, BIG, "rad", 0, SC_REQUIRED },
    { "substep",  SC_NUMBER,  AT(T, substep),  0, 1, "s", 0, SC_REQUIRED },
    { "turns",    SC_VEC2,    AT(T, turns),    -2147483647, 2147483647, "1", 0, SC_REQUIRED },
};
const sc_list sc_list_state = { "state", state_rows, COUNT(state_rows) };
#undef T

#define T sc_joint_def
#define ROW_A            { "a",       SC_END,    AT(T, a),       0, 0, NULL, 1, 0 }
#define ROW_AT           { "at",      SC_VEC2,   AT(T, at),      -FAR, FAR, "m", 0, 0 }
#define ROW_AT_A         { "at_a",    SC_VEC2,   AT(T, at_a),    -FAR, FAR, "m", 0, 0 }
#define ROW_AT_B         { "at_b",    SC_VEC2,   AT(T, at_b),    -FAR, FAR, "m", 0, 0 }
#define ROW_AXIS         { "axis",    SC_VEC2,   AT(T, axis),    -FAR, FAR, "1", 0, 0 }
#define ROW_B            { "b",       SC_END,    AT(T, b),       0, 0, NULL, 2, 0 }
#define ROW_COLLIDE      { "collide", SC_BOOL,   AT(T, collide), 0, 0, NULL, 0, 0 }
#define ROW_HIDDEN       { "hidden",  SC_BOOL,   AT(T, hidden),  0, 0, NULL, 0, 0 }
#define ROW_LIMITS(low, unit) { "limits", SC_LIMITS, AT(T, limits), low, BIG, unit, 0, 0 }
#define ROW_MAX_FORCE    { "max_force",  SC_NUMBER, AT(T, max_force),  0, BIG, "N", 0, 0 }
#define ROW_MAX_TORQUE   { "max_torque", SC_NUMBER, AT(T, max_torque), 0, BIG, "N m", 0, 0 }
#define ROW_MOTOR        { "motor",   SC_RECORD, AT(T, motor),   0, 0, "motor", 0, 0 }
#define ROW_NAME         { "name",    SC_STRING, AT(T, name),    0, 0, NULL, 0, 0 }
#define ROW_RATIO(low, flags) { "ratio", SC_NUMBER, AT(T, ratio), low, 1e6, "1", 0, flags }
#define ROW_REFERENCE(unit) { "reference", SC_NUMBER, AT(T, reference), -1e6, 1e6, unit, 0, 0 }
#define ROW_RESTITUTION  { "restitution", SC_NUMBER, AT(T, restitution), 0, 1, "1", 0, 0 }
#define ROW_SPRING       { "spring",  SC_RECORD, AT(T, spring),  0, 0, "spring", 0, 0 }
#define ROW_STATE        { "state",   SC_RECORD, AT(T, state),   0, 0, "state", 0, 0 }

// What begins and what ends the rows of nearly every kind.
#define ROWS_BREAK PL_JOINT_BOUND_ROWS(SC_ROW, ) ROW_COLLIDE, ROW_HIDDEN
#define ROWS_SLIDER                                                                                 \
    ROW_A, ROW_AT, ROW_AXIS, ROW_B, ROWS_BREAK, ROW_LIMITS(-BIG, "m"), ROW_MOTOR, ROW_NAME,          \
        ROW_REFERENCE("m"), ROW_RESTITUTION, ROW_SPRING, ROW_STATE

static const sc_field revolute_rows[] = {
    ROW_A, ROW_AT, ROW_B, ROWS_BREAK, ROW_LIMITS(-BIG, "rad"), ROW_MOTOR, ROW_NAME,
    ROW_REFERENCE("rad"), ROW_RESTITUTION, ROW_SPRING, ROW_STATE,
};
static const sc_field prismatic_rows[] = { ROWS_SLIDER };
static const sc_field weld_rows[] = { ROW_A, ROW_AT, ROW_B, ROWS_BREAK, ROW_NAME, ROW_SPRING, ROW_STATE };
static const sc_field wheel_rows[] = { ROWS_SLIDER };
static const sc_field distance_rows[] = {
    ROW_A, ROW_AT_A, ROW_AT_B, ROW_B, ROWS_BREAK,
    { "length", SC_NUMBER, AT(T, length), 0, SIZE, "m", 0, SC_ABOVE },
    ROW_LIMITS(0, "m"), ROW_NAME, ROW_RESTITUTION, ROW_SPRING, ROW_STATE,
};
static const sc_field mouse_rows[] = {
    ROW_A, ROW_AT, ROW_B, ROWS_BREAK, ROW_MAX_FORCE, ROW_NAME, ROW_SPRING, ROW_STATE,
    { "target", SC_VEC2, AT(T, target), -FAR, FAR, "m", 0, 0 },
};
static const sc_field motor_rows[] = {
    ROW_A,
    { "angle", SC_NUMBER, AT(T, angle), -BIG, BIG, "rad", 0, 0 },
    ROW_AT, ROW_B, ROWS_BREAK, ROW_MAX_FORCE, ROW_MAX_TORQUE, ROW_NAME,
    { "offset", SC_VEC2, AT(T, offset), -FAR, FAR, "m", 0, 0 },
    ROW_SPRING, ROW_STATE,
};
static const sc_field gear_rows[] = {
    ROW_A, ROW_AXIS, ROW_B, ROWS_BREAK, ROW_NAME, ROW_RATIO(-1e6, 0), ROW_STATE,
};
static const sc_field pulley_rows[] = {
    ROW_A, ROW_AT_A, ROW_AT_B, ROW_B, ROWS_BREAK, ROW_NAME, ROW_RATIO(0, SC_ABOVE), ROW_STATE,
    { "wheel_a", SC_VEC2, AT(T, wheel_a), -FAR, FAR, "m", 0, SC_REQUIRED },
    { "wheel_b", SC_VEC2, AT(T, wheel_b), -FAR, FAR, "m", 0, SC_REQUIRED },
};
static const sc_field ratchet_rows[] = {
    ROW_A, ROW_AT, ROW_B, ROWS_BREAK, ROW_NAME,
    { "pitch", SC_NUMBER, AT(T, pitch), -BIG, BIG, "rad", 0, SC_REQUIRED },
    ROW_STATE,
};
static const sc_field friction_rows[] = {
    ROW_A, ROW_AT, ROW_B, ROWS_BREAK, ROW_MAX_FORCE, ROW_MAX_TORQUE, ROW_NAME, ROW_STATE,
};
static const sc_field cable_rows[] = {
    ROW_A, ROW_AT_A, ROW_AT_B, ROW_B, ROWS_BREAK,
    { "length", SC_NUMBER, AT(T, length), 0, SIZE, "m", 0, SC_ABOVE },
    ROW_NAME,
    { "radius_a", SC_NUMBER, AT(T, radius_a), -SIZE, SIZE, "m", 0, 0 },
    { "radius_b", SC_NUMBER, AT(T, radius_b), -SIZE, SIZE, "m", 0, 0 },
    ROW_STATE,
};
// Of a kind without rows of its own here; what it does not have of these, the world refuses.
#define GENERAL_ROWS                                                                                \
    ((const sc_field[]){ ROW_A, ROW_AT, ROW_AXIS, ROW_B, ROWS_BREAK, ROW_LIMITS(-BIG, "rad or m"),   \
                         ROW_MAX_FORCE, ROW_MAX_TORQUE, ROW_MOTOR, ROW_NAME, ROW_RATIO(-1e6, 0),     \
                         ROW_REFERENCE("rad or m"), ROW_RESTITUTION, ROW_SPRING, ROW_STATE })
#define OWN_revolute  , revolute_rows
#define OWN_prismatic , prismatic_rows
#define OWN_weld      , weld_rows
#define OWN_wheel     , wheel_rows
#define OWN_distance  , distance_rows
#define OWN_mouse     , mouse_rows
#define OWN_motor     , motor_rows
#define OWN_gear      , gear_rows
#define OWN_pulley    , pulley_rows
#define OWN_ratchet   , ratchet_rows
#define OWN_friction  , friction_rows
#define OWN_cable     , cable_rows
// Where OWN_<name> is no macro, the row behind is the second.
#define SECOND(first, second, ...) second
#define ROWS_OF(...)               SECOND(__VA_ARGS__, GENERAL_ROWS, 0)

const sc_list sc_list_joints[SC_JOINT_KINDS] = {
#define JOINT_LIST(NAME, name, text) [PLUMB_##NAME] = { #name, ROWS_OF(OWN_##name), COUNT(ROWS_OF(OWN_##name)) },
    PLUMB_JOINT_LIST(JOINT_LIST)
#undef JOINT_LIST
};
#undef T
// clang-format on

const sc_list *sc_list_named(const char *name)
{
    static const sc_list *const lists[] = { &sc_list_motor, &sc_list_spring, &sc_list_state,
                                            &sc_list_character };
    for (size_t i = 0; i < sizeof lists / sizeof *lists; i++) {
        if (strcmp(lists[i]->name, name) == 0) {
            return lists[i];
        }
    }
    return NULL;
}
