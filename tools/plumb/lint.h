/// lint.h - the rules of `plumb check --lint`, and a scene held to them.
#ifndef PLUMB_LINT_H
#define PLUMB_LINT_H

#include "scene_args.h"

/// X(name, the function pl_lint_<look> that looks, what the rule says, what to do). The help prints them.
// clang-format off
#define LINT_RULES(X)                                                                                                        \
    X("mass-ratio", masses, "a body rests on, is joined to, or turns with one that is too light for it",                          \
      "a heavier light one, substeps=16, direct_joints=true for joints, solver=\"exact\", or a tolerance")                   \
    X("fast-and-thin", speeds, "a body goes farther in a step than it and what it may meet are thick, seen from there",               \
      "continuous=true on one of the two, a shorter step, or thicker shapes")                                                \
    X("stiff-spring", springs, "a spring, or a field that turns a dipole, is stiffer than substeps can follow",      \
      "a softer spring or weaker field, more substeps, or a rigid joint")                                                                    \
    X("filter-meets-none", filters, "a filter lets a shape meet no other",                                           \
      "let categories and masks name one another; what is to meet nothing says so")                                          \
    X("effect-on-none", effects, "a setting, a surface or a joint acts on nothing",                                  \
      "take it away, or give it force, friction or a dynamic body")                                                                              \
    X("energy-gain", gains, "a restitution above 1: each bounce gives energy, until restitution_cap ends it",       \
      "1 or less; a bumper that is meant says so")                                                                          \
    X("overlap", overlaps, "bodies begin inside one another and are pushed apart",                                   \
      "move them apart, let their filters not meet, or join them")                                                           \
    X("far-anchor", anchors, "a joint holds two bodies at a point far outside of both",                              \
      "at = {x, y} is in the world's coordinates; a lever that is meant says so")                                    \
    X("size", sizes, "a body is thinner or thicker than is measured, or too far from the origin for its size",       \
      "other units of length, thicker shapes, places near the origin, or double precision")                                \
    X("units", units, "a number looks like degrees, pixels, a density of another unit, or a y that points down",            \
      "radians or angle_deg, metres, kg/m^2, gravity = {0, -9.81}; what is meant says so")
// clang-format on

/// Prints what the rules find in a scene as it begins, and what to do, but for rules that are `allowed` or that the scene allows
/// itself. Answers the number of findings; -1 after a message: out of memory, or what was allowed is no rule.
int lint_scene(const scene_run *run, const char *path, const cli_texts *allowed);

#endif
