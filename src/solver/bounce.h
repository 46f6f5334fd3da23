// bounce.h - one contact that may bounce: when its points are struck in a substep, and what that does.
#ifndef PL_BOUNCE_H
#define PL_BOUNCE_H

#include "solver/solver.h"

typedef struct pl_approach {
    bool due;     // an impact falls into this substep and bounces
    bool clear;   // the point stays apart in this substep
    double speed; // [m/s] at which the surfaces meet, > 0
    double time;  // [s] since the start of the substep
} pl_approach;

// What becomes of the points of a contact in the substep of h [s] if nothing else strikes its bodies: `at`, the
// impact's `clear`, and, while it has impacts left, `due` and the `time` of the first.
void pl_bounce_foresee(const plumb_world *world, pl_impact *impact, double h, pl_approach at[2]);

// Resolves the impacts that are due, friction included; true when there was one.
bool pl_bounce_resolve(plumb_world *world, const pl_impact *impact, const pl_approach at[2]);

// One of several impacts of a moment.
typedef struct pl_bounce {
    pl_impact *impact;
    pl_approach at[2];
    double wanted[2], impulse[2]; // [m/s] along the normal at the end, [N s]
} pl_bounce;

// Resolves the impacts of a moment that are due, friction included; `impulse` says which there were.
void pl_bounce_resolve_together(plumb_world *world, pl_bounce *all, uint32_t count);

#endif
