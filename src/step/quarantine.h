// quarantine.h - bodies that a step would leave without a finite state are taken out of it.
#ifndef PL_QUARANTINE_H
#define PL_QUARANTINE_H

#include "world/tables/step.h"
#include "core/memory.h"
#include "plumb/event.h"

void pl_quarantine_free(pl_memory *memory, pl_quarantine *quarantine);

// A step begins: nobody has been taken out in it.
void pl_quarantine_begin(plumb_world *world);
// Before anything of the step has been found out: takes out every body whose velocity or force has no finite
// end in dt [s]; `pass` left it so.
void pl_quarantine_guard(plumb_world *world, plumb_real dt, const char *pass);
// Later in the step: whom it takes out has been seen already, so the step is to be taken anew.
void pl_quarantine_guard_late(plumb_world *world, plumb_real dt, const char *pass);
// Behind the graph: keeps what the solver will change. False when out of memory.
bool pl_quarantine_keep(plumb_world *world);
// Behind the solver `pass`: the same for what it did to bodies.
void pl_quarantine_judge(plumb_world *world, plumb_real dt, const char *pass);
// In a step that is to be taken anew: makes the solver's doings undone.
void pl_quarantine_undo(plumb_world *world);
// The step is over: takes out those.
void pl_quarantine_finish(plumb_world *world);

#endif
