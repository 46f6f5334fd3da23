// quarantine.h - bodies that a step would leave without a finite state are taken out of it.
#ifndef PL_QUARANTINE_H
#define PL_QUARANTINE_H

#include "core/memory.h"
#include "plumb/event.h"

typedef struct pl_quarantine {
    plumb_quarantine events[PLUMB_QUARANTINE_MAX]; // of the last step, the first ones
    int event_count;
    bool again;       // the step is to be taken anew, without who was found
    bool lost;        // some body is marked PL_BODY_LOST: it is taken out when the step is over
    uint32_t attempt; // how often the step has been taken anew
    // What the solver changes that outlives the step, as it was before.
    pl_buffer joints;  // pl_kept_joint of each joint that is awake
    pl_buffer rolling; // near_real a manifold, where surfaces roll hard
    bool kept;
    plumb_real since; // [s] world->sleep.since
} pl_quarantine;

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
// Tells of a body that moved to where it has no finite state. It has been put back.
void pl_quarantine_note_lost(plumb_world *world, uint32_t row);
// The step is over: takes out those.
void pl_quarantine_finish(plumb_world *world);

#endif
