// joint.h - the properties of joints. See row.h. Which kind has which is told by its class (joints/joint.h); most
// words of scenes are those of a kind (tools/scene/lists_joints.c).
#ifndef PL_SCHEMA_JOINT_H
#define PL_SCHEMA_JOINT_H

#include "plumb/joint.h"
#include "schema/row.h"

// From the list of kinds: "revolute|...", and the last of them.
#define PL_JOINT_KIND_CHOICE(NAME, name, text)  "|" #name
#define PL_JOINT_KIND_CHOICES                   &("" PLUMB_JOINT_LIST(PL_JOINT_KIND_CHOICE))[1]
#define PL_JOINT_KIND_COUNTED(NAME, name, text) +1
#define PL_JOINT_KIND_LAST                      (PLUMB_JOINT_LIST(PL_JOINT_KIND_COUNTED) - 1)

// clang-format off
// Of every kind: bounds of its reaction.
#define PL_JOINT_BOUND_ROWS(R, X)                                                                   \
    R(X, STATE, REAL, break_force, SAID(break_force), "N", ABOVE(0, NO_END), 0, NO_ZERO,            \
      "mean force over a step beyond which it breaks")                                              \
    R(X, STATE, REAL, break_torque, SAID(break_torque), "N m", ABOVE(0, NO_END), 0, NO_ZERO,        \
      "mean torque over a step beyond which it breaks")                                             \
    R(X, STATE, REAL, break_impulse, SAID(break_impulse), "N s", ABOVE(0, NO_END), 0, NO_ZERO,      \
      "impulse in a step beyond which it breaks, whatever the length of the step")                  \
    R(X, STATE, BOOL, tell_impulse, SAID(tell_impulse), "1", CHOICES(1), 0, NO_ZERO,                \
      "tells what it gave over the whole step")                                                     \
    R(X, STATE, BOOL, disabled, UNSAID, "1", CHOICES(1), 0, NO_ZERO,                                \
      "does nothing until it is enabled")                                                           \
    R(X, STATE, REAL, event_force, SAID(event_force), "N", ABOVE(0, NO_END), 0, NO_ZERO,            \
      "mean force over a step beyond which it makes a strain event")                                \
    R(X, STATE, REAL, event_torque, SAID(event_torque), "N m", ABOVE(0, NO_END), 0, NO_ZERO,        \
      "mean torque over a step beyond which it makes a strain event")

#define PL_JOINT_DESC_ROWS(R, X)                                                                         \
    R(X, OWN, VEC2, anchor, UNSAID, "m", FROM(-1e9, 1e9), 0, NO_ZERO,                               \
      "the common point; distance, pulley: on A; mouse: the point of B; cable: centre of A's rim")   \
    R(X, OWN, VEC2, anchor_b, UNSAID, "m", FROM(-1e9, 1e9), 0, NO_ZERO,                             \
      "distance, pulley: on B; cable: centre of B's rim")                                           \
    R(X, OWN, VEC2, ground_a, UNSAID, "m", ANY, 0, NO_ZERO, "pulley: the wheel of A's rope")        \
    R(X, OWN, VEC2, ground_b, UNSAID, "m", ANY, 0, NO_ZERO, "pulley: the wheel of B's rope")        \
    R(X, OWN, VEC2, axis, UNSAID, "1", ANY, 0, NO_ZERO,                                             \
      "prismatic, wheel: direction of the value; gear: B's travel along it")                        \
    R(X, STATE, JOINT_KIND, kind, UNSAID, PL_JOINT_KIND_CHOICES, CHOICES(PL_JOINT_KIND_LAST),       \
      PLUMB_REVOLUTE, NO_ZERO, "what it does")                                                      \
    R(X, OWN, REAL, reference, UNSAID, "rad or m", FROM(-1e6, 1e6), 0, NO_ZERO,                     \
      "value as things are when it is made")                                                        \
    R(X, STATE, BOOL, enable_limit, UNSAID, "1", CHOICES(1), 0, NO_ZERO,                            \
      "lower <= value <= upper")                                                                    \
    R(X, STATE, REAL, lower, UNSAID, "rad or m", ANY, 0, NO_ZERO, "least value")                    \
    R(X, STATE, REAL, upper, UNSAID, "rad or m", ANY, 0, NO_ZERO, "greatest value")                 \
    R(X, STATE, REAL, restitution, UNSAID, "1", FROM(0, 1), 0, NO_ZERO,                             \
      "of the limit: share of the rate that it gives back")                                         \
    R(X, STATE, BOOL, enable_motor, UNSAID, "1", CHOICES(1), 0, NO_ZERO,                            \
      "drives the rate of the value")                                                               \
    R(X, STATE, REAL, motor_speed, UNSAID, "rad/s or m/s", ANY, 0, NO_ZERO, "wanted rate")          \
    R(X, STATE, REAL, max_motor, UNSAID, "N m or N", FROM(0, NO_END), 0, NO_ZERO,                   \
      "greatest torque or force of the motor")                                                      \
    R(X, STATE, REAL, hertz, UNSAID, "1/s", FROM(0, NO_END), 0, NO_ZERO,                            \
      "frequency of the spring; 0: none, or rigid")                                                 \
    R(X, STATE, REAL, damping, UNSAID, "1", FROM(0, NO_END), 0, NO_ZERO,                            \
      "damping ratio of the spring")                                                                \
    R(X, STATE, REAL, stiffness, UNSAID, "N/m or N m/rad", FROM(0, NO_END), 0, NO_ZERO,             \
      "of the spring, instead of its frequency")                                                    \
    R(X, STATE, REAL, damper, UNSAID, "N s/m or N m s/rad", FROM(0, NO_END), 0, NO_ZERO,            \
      "force or torque by the rate against which it acts, instead of the damping ratio")            \
    R(X, STATE, REAL, rest, UNSAID, "rad or m", ANY, 0, NO_ZERO,                                    \
      "value at which the spring is at rest")                                                       \
    R(X, STATE, REAL, length, UNSAID, "m", FROM(0, NO_END), 0, NO_ZERO,                             \
      "distance: of rod or spring; cable: of its free run; 0: as things are")                       \
    R(X, OWN, REAL, radius_a, UNSAID, "m", FROM(-1e9, 1e9), 0, NO_ZERO,                             \
      "cable: of A's rim; > 0: to B it runs on the left, < 0: on the right; 0: it is tied there")   \
    R(X, OWN, REAL, radius_b, UNSAID, "m", FROM(-1e9, 1e9), 0, NO_ZERO,                             \
      "cable: of B's rim, likewise")                                                                \
    R(X, STATE, REAL, ratio, UNSAID, "1", ANY, 0, NO_ZERO, "gear, pulley: 0 means 1")               \
    R(X, STATE, REAL, pitch, UNSAID, "rad", ANY, 0, NO_ZERO, "ratchet: a tooth")                    \
    R(X, STATE, REAL, max_force, UNSAID, "N", FROM(0, NO_END), 0, NO_ZERO,                          \
      "mouse, motor: 0 is unbounded; friction: as given")                                           \
    R(X, STATE, REAL, max_torque, UNSAID, "N m", FROM(0, NO_END), 0, NO_ZERO, "likewise")           \
    PL_JOINT_BOUND_ROWS(R, X)                                                                       \
    R(X, OWN, BOOL, collide_connected, UNSAID, "1", CHOICES(1), 0, NO_ZERO,                         \
      "the two bodies collide with one another")
// clang-format on

#endif
