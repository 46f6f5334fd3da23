// data.h - what passes and systems read and write, by name: for the schedule, and for the check of what a row
// writes (check.c).
#ifndef PL_DATA_H
#define PL_DATA_H

#include "plumb/base.h"

// X(NAME, "name", what it is)
#define PL_DATA(X)                                                                                 \
    X(ROWS, "rows",                                                                                \
      "which body has which row, and in which partition; who moves it moves columns")              \
    X(POSES, "poses", "places, rotations, centres")                                                \
    X(VELOCITIES, "velocities", "of bodies, linear and angular")                                   \
    X(FORCES, "forces", "and torques for the next step")                                           \
    X(MASSES, "masses", "and inertias")                                                            \
    X(BODY_SETTINGS, "body settings", "damping, drag, engines, speed caps, time scales")           \
    X(TARGETS, "targets", "of kinematic bodies")                                                   \
    X(PIECES, "pieces", "convex parts of shapes")                                                  \
    X(MATERIALS, "materials", "and their pairs")                                                   \
    X(GRIDS, "grids", "fat boxes and the cells that have them")                                    \
    X(PAIRS, "pairs", "of pieces that may touch, with their impulses")                             \
    X(MANIFOLDS, "manifolds", "of contacts")                                                       \
    X(INTERNAL_EDGES, "internal edges", "edges and corners of ground that neighbours cover")       \
    X(JOINTS, "joints", "their impulses, errors and reactions")                                    \
    X(ISLANDS, "islands", "what sleeps, and how long bodies have rested")                          \
    X(LIQUID, "liquid", "its particles")                                                           \
    X(AIR, "air", "its velocities, smoke and heat")                                                \
    X(HEAT, "heat", "of bodies: temperatures, melt, growth")                                       \
    X(SOFT_BODIES, "soft bodies", "their nodes and elements")                                      \
    X(WAVES, "waves", "of surfaces of water")                                                      \
    X(CHARACTERS, "characters", "bodies that walk")                                                \
    X(SENSORS, "sensors", "what they overlap")                                                     \
    X(SOLVER_BODIES, "solver bodies", "velocities and ways of bodies in the substeps")             \
    X(ACCELERATIONS, "accelerations", "of solver bodies in the substep")                           \
    X(CONSTRAINTS, "constraints", "colours, lanes, bundles, impulses of the substep")              \
    X(MOVERS, "movers", "bodies that moved farther than their slack")                              \
    X(EVENTS, "events", "of the step")                                                             \
    X(SETTINGS, "settings", "of the world")                                                        \
    X(COMPONENTS, "components", "of the user's")                                                   \
    X(TIME, "time", "and the number of steps")

enum {
#define PL_DATA_INDEX(name, text, what) PL_DATA_##name,
    PL_DATA(PL_DATA_INDEX)
#undef PL_DATA_INDEX
        PL_DATA_COUNT
};

// Bits of a mask.
enum {
#define PL_DATA_BIT(name, text, what) PL_##name = 1 << PL_DATA_##name,
    PL_DATA(PL_DATA_BIT)
#undef PL_DATA_BIT
        PL_DATA_NOTHING = 0
};

// Name of the data of a bit's index.
const char *pl_data_name(int index);
// The mask of names with commas between them, as "velocities, forces". What is no data may be a component of the
// world's (world may be null): then it is PL_COMPONENTS. False where a name is none of these: *unknown, of
// *length characters.
bool pl_data_parse(const plumb_world *world, const char *text, uint32_t *mask, const char **unknown,
                   int *length);

#endif
