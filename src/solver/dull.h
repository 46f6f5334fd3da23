// dull.h - impacts of dull contacts: of so little restitution that they strike once a substep and are done. Their
// numbers as the kernels of dull.simd.c have them, and what runs these kernels.
#ifndef PL_DULL_H
#define PL_DULL_H

#include "solver/solver.h"

// Of each bundle three fields, of a real a lane. Separations are PL_APART and restitution 0 where no dull
// contact is.
#define PL_PREDICTED_SEPARATION(j) ((size_t)(j)) // [m] at the start of the step
#define PL_PREDICTED_RESTITUTION   2
#define PL_PREDICTED_FIELDS        3

enum {
    PL_DULL_STRUCK = 1, // in this substep
    PL_DULL_HIT = 2     // in this step: its pair has been told
};

struct pl_dull_call {
    pl_solver_body *bodies;
    pl_solver_motion *motions;
    near_real *residuals, *struck; // a quad, a real a slot
    uint32_t dynamic_slots;        // slots from here on do not move
    void *bundles;
    const uint32_t *color_first; // bundles of the colours: a kernel may be given several at once
    const uint32_t *lanes;
    pl_manifold *manifolds;
    pl_pair *pairs;
    near_real *fields;
    uint8_t *marks;           // a lane: after a look 1 where it is left open, else PL_DULL_...
    bool looks_up;            // surfaces run, or impulses are added up
    near_real h;              // [s]
    double restitution_speed; // [m/s]
};

// Once a step: fills in the fields; returns how many contacts are lively, not dull.
uint32_t pl_dull_impacts_prepare(const plumb_world *world);

// Marks the lanes that the prediction for a substep of h [s] leaves open (prediction.h).
void pl_dull_impacts_look(const plumb_world *world, near_real h);

// The impacts of a substep of h [s] where all that bounces is dull and no axis is locked.
void pl_dull_impacts_run(plumb_world *world, near_real h);

#endif
