// impact_queue.h - the impacts of a substep in the order of their moments, and what else meets a body
// that was struck.
//
// A binary heap over world->solver.impacts. Equal moments: the lower index first, so that the order
// does not depend on how the heap came about. Room is reserved with the impacts (graph.c).
#ifndef PL_IMPACT_QUEUE_H
#define PL_IMPACT_QUEUE_H

#include "solver/solver.h"

// An empty queue; links the impacts of every dynamic slot. Once a step. O(impacts + slots).
void pl_impact_queue_link(pl_solver *solver);

// Puts an impact where its `due` and `time` say: in, elsewhere, or out. O(log impacts).
void pl_impact_queue_put(pl_solver *solver, uint32_t impact);

// The impact that comes first; NULL: none is due.
pl_impact *pl_impact_queue_first(const pl_solver *solver);

// Impacts of a dynamic slot, from the lowest: the first one, and the one after `impact`; PL_NONE: no more.
uint32_t pl_impact_of_slot(const pl_solver *solver, uint32_t slot);
uint32_t pl_impact_after(const pl_solver *solver, uint32_t slot, uint32_t impact);

#endif
