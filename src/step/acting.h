// acting.h - whom rows of the substep act on, and the user's systems as such rows.
#ifndef PL_ACTING_H
#define PL_ACTING_H

#include "world/substep.h"
#include "step/pass.h"

// Before the graph: dynamic bodies that systems of the substep act on, so that the solver moves them. False when out
// of memory.
bool pl_acting_call(plumb_world *world);
// Behind the graph, for a step of dt [s]: who has which slot. False when out of memory.
bool pl_acting_find(plumb_world *world, plumb_real dt);

// A system of the user's as a row.
pl_substep_fn pl_system_row;

#endif
