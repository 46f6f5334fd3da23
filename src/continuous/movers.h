// movers.h - the list of bodies that are swept in this step.
#ifndef PL_MOVERS_H
#define PL_MOVERS_H

#include "continuous/swept_motion.h"

// Completes the list that pl_solver_finish began: what may have been passed or pressed through
// though it moves slowly joins it; strays are told. `dt` [s] is the step just taken.
void pl_movers_complete(plumb_world *world, real dt);

// The mover of a body row; NULL for one that is not swept.
pl_mover *pl_mover_find(const plumb_world *world, uint32_t row);
// The motion of any body, mover or not.
pl_swept_motion pl_mover_motion(const plumb_world *world, uint32_t row, real dt, double ox,
                                double oy);

static inline bool pl_row_is_dynamic(const plumb_world *world, uint32_t row)
{
    return world->bodies.type[row] == PLUMB_DYNAMIC;
}

#endif
