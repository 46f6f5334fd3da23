/// alarm_list.h - what the watchdog looks for (plumb/watchdog.h): a list and nothing else, for programs that print it too.
#ifndef PLUMB_ALARM_LIST_H
#define PLUMB_ALARM_LIST_H

#include "plumb/base.h"

/// The detectors: X(NAME, "name", bound, unit of value and bound, what it looks for, what to do). The one list: enum,
/// bounds, docs, help of the command line.
// clang-format off
#define PLUMB_ALARM_LIST(X)                                                                                          \
    X(ENERGY_JUMP, "energy-jump", 1, "1",                                                                            \
      "what touches or is joined gains more energy in a step than gravity, forces, springs, motors and moving bodies give it, " \
      "by more than so many times what it had in motion and a metre per second is worth",                             \
      "look for bodies inside one another and joints far apart; more substeps, direct_joints, or solver exact")       \
    X(RUNAWAY_SPEED, "runaway-speed", 4, "1",                                                                        \
      "a body is so many times faster than falls, springs, motors, forces and calls account for",                     \
      "see what it touched or is joined to; a max_speed, more substeps, a shorter step")                              \
    X(TUNNELLING, "tunnelling", 1, "1",                                                                              \
      "a body has passed through another one within a step, by a way of more than so many half widths of the thinner one", \
      "continuous on one of the two, no no_continuous, a shorter step, or thicker shapes")                            \
    X(SINKING, "sinking", 0.4, "1",                                                                                  \
      "bodies are inside one another by more than so much of the thinner one's half width, and ever deeper",          \
      "less unequal masses, more substeps, a stiffer contact_hertz, or solver exact")                                 \
    X(CONTACT_WITHOUT_TOUCH, "contact-without-touch", 0.1, "m",                                                     \
      "a contact pushed at the end of the step, but the shapes are farther apart than that and twice the way of their bodies in a substep", \
      "shorter steps or more substeps for what turns fast; place nothing by hand in systems behind the solver")       \
    X(PAIR_EXPLOSION, "pair-explosion", 3, "1",                                                                      \
      "so many contacts a piece are deep ones; pieces that do not overlap have 3 at the most",                        \
      "do not make or move bodies into one another; filters, or fewer at a time")                                     \
    X(TORN_JOINT, "torn-joint", 0.5, "1",                                                                            \
      "a joint is apart by more than so much of the smaller body's extent, and not coming together",                  \
      "direct_joints, more substeps, less unequal masses; a break_force if it may give way")                          \
    X(OUT_OF_SCALE, "out-of-scale", 0.1, "1",                                                                        \
      "a body is so far out that its place is rounded by more than so much of its extent, or as fast within a step",  \
      "remove what has left the scene; places near the origin; double or far precision")
// clang-format on

#endif
