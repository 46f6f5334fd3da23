/// accuracy.h - the dial: a world that chooses its solver and its substeps by the error that it may make.
///
///     plumb_world_create(&(plumb_world_desc){ .tolerance = (plumb_real)1e-3 }, &world);
///     for (...) plumb_world_step(world, dt);
///     plumb_accuracy a = plumb_world_accuracy(world);
///     if (!a.met) printf("%g off instead of %g: %s\n", a.error, a.tolerance, a.reason);
///
/// What `tolerance` means: the share of the way of what moves farthest by which bodies may be elsewhere, or of its speed
/// by which they may be faster or slower, after PLUMB_ACCURACY_HORIZON seconds; and twice that share of the smallest
/// body by which contacts may overlap and joints be apart. The world takes care of what its substeps and solver do to it; of
/// what a step freezes (the direction of a contact that is rolled over or struck) it knows how much that is, and tells.
/// It is an estimate, not a bound: where motion is chaotic, errors of any size grow beyond it.
///
/// How: after each step it looks how fast things swing, how deep contacts and how far apart joints are, what bears on what, and
/// how far contacts turned; the next step takes as many substeps as that asks for, or solves joints together, or all
/// (PLUMB_SOLVER_EXACT; from there it does not come back). Systems are called as ever: those of a substep once in each.
/// All that it goes by is state: a world that is rolled back, restored or replayed chooses the same again.
#ifndef PLUMB_ACCURACY_H
#define PLUMB_ACCURACY_H

#include "plumb/world.h"

PLUMB_BEGIN

#define PLUMB_ACCURACY_HORIZON 10.0 ///< [s]

/// Named settings: X(NAME, name, tolerance, solver, substeps, text). With a tolerance, solver and substeps are only what
/// the world begins with.
// clang-format off
#define PLUMB_ACCURACY_LIST(X)                                                                                  \
    X(ARCADE,    arcade,    0,    PLUMB_SOLVER_SOFT, 2, "cheap: it looks right")                                 \
    X(GAME,      game,      0,    PLUMB_SOLVER_SOFT, 4, "the default")                                           \
    X(PRECISE,   precise,   1e-3, PLUMB_SOLVER_SOFT, 4, "within a thousandth: engineering, teaching, robots")    \
    X(REFERENCE, reference, 1e-5, PLUMB_SOLVER_SOFT, 16, "what others are compared with; pays in double precision")
// clang-format on

typedef enum plumb_accuracy_preset {
#define PLUMB_ACCURACY_ENUM(NAME, name, tolerance, solver, substeps, text) PLUMB_ACCURACY_##NAME,
    PLUMB_ACCURACY_LIST(PLUMB_ACCURACY_ENUM)
#undef PLUMB_ACCURACY_ENUM
        PLUMB_ACCURACY_PRESETS
} plumb_accuracy_preset;

/// "arcade", ... and what it is for; null for what is none.
PLUMB_API const char *plumb_accuracy_name(plumb_accuracy_preset preset);
PLUMB_API const char *plumb_accuracy_text(plumb_accuracy_preset preset);
/// Sets tolerance, solver, substeps and iterations of a descriptor. Errors: E_NULL, E_RANGE (no such preset).
PLUMB_API plumb_result plumb_accuracy_apply(plumb_accuracy_preset preset, plumb_world_desc *desc);

/// Changes the tolerance, 0 to 0.5, from the next step on; 0: solver and substeps stay as they were chosen last. What is known
/// of the error so far is forgotten. Errors: E_NULL, E_RANGE, E_NOT_FINITE, E_LOCKED.
PLUMB_API plumb_result plumb_world_set_tolerance(plumb_world *world, plumb_real tolerance);

/// What a world with a tolerance chose, and what it cost.
typedef struct plumb_accuracy {
    double tolerance;    ///< [-] 0: it has none, and nothing below is known
    double error;        ///< [-] estimate of what tolerance bounds: of the last seconds, as many as the horizon
    double motion;       ///< [-] of that, what substeps make of motion
    double frozen;       ///< [-] of that, what turned while a step held it still, and what long chains of impacts rounded
    double rest;         ///< [-] overlaps and gaps of joints, as half their share of the smallest body
    double worst;        ///< [-] the largest `error` since the tolerance was set
    plumb_solver solver; ///< of the last step
    int substeps;        ///< [-] likewise
    bool direct_joints;  ///< likewise
    bool met;            ///< `worst` is within the tolerance; the first miss of a world is told in the log, too
    const char *reason;  ///< why this solver and these substeps; a sentence that lives as long as the program
    uint64_t steps;      ///< since the tolerance was set
    uint64_t solved;     ///< substeps in these
} plumb_accuracy;

/// O(1). All zero for null.
PLUMB_API plumb_accuracy plumb_world_accuracy(const plumb_world *world);

PLUMB_END

#endif
