// measure.h - a world that measures its own error: rows of the step, and what stands around the other rows.
#ifndef PL_MEASURE_H
#define PL_MEASURE_H

#include "solver/substep.h"
#include "world/tables/measure.h"

void pl_measure_free(pl_memory *memory, pl_measure *m);

// Around rows that are done once a step, by what runs them; NULL: systems of the user's.
typedef plumb_result pl_once_fn(plumb_world *world, plumb_real dt);
void pl_measure_before(plumb_world *world, pl_once_fn *run);
void pl_measure_after(plumb_world *world, pl_once_fn *run, plumb_real dt);

// Whose work it is what pushes all step long: PL_STEADY_...
plumb_work pl_measure_steady(int i);

// Around rows of the substeps.
void pl_measure_before_row(pl_substep *s);
void pl_measure_after_row(pl_substep *s);

#endif
