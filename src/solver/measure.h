// measure.h - contacts of the classic solver, while a world measures itself (step/measure.c).
#ifndef PL_SOLVER_MEASURE_H
#define PL_SOLVER_MEASURE_H

#include "solver/solver.h"
#include "world/tables/measure.h"

// What impulses have done since they were `kept` (null: all of them), and what they leave of the law of contacts.
void pl_classic_measure(const plumb_world *world, const pl_classic_contact *kept, pl_measuring *m);
void pl_classic_residual(const plumb_world *world, pl_measuring *m);

#endif
