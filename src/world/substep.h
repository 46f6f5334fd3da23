// substep.h - what a row of the substep is called with: one cluster of islands, in the hands of some threads.
//
// Rows are the solver's, of effects, of users. What they share stands here; who runs them, and what only the solver's
// own rows need, is in solver/substep.h.
#ifndef PL_WORLD_SUBSTEP_H
#define PL_WORLD_SUBSTEP_H

#include "core/tasks.h"
#include "schema/passes.h"
#include "world/tables/solver.h"

typedef struct pl_substep pl_substep;
typedef void pl_substep_fn(pl_substep *s);

// A row of the substep as the schedule has it.
typedef struct pl_substep_row {
    pl_substep_fn *run; // NULL: nothing, in clusters of the soft step
    pl_substep_fn
        *exact; // likewise, in that of islands that are solved exactly in a world of the soft step
    uint32_t place;  // in the schedule: whose time it is
    uint32_t system; // of the user's; else PL_NO_SYSTEM
} pl_substep_row;

struct pl_substep {
    plumb_world *world;
    const pl_cluster *cluster;
    pl_tasks *tasks;            // null: one thread
    uint32_t thread;            // whose room the cluster has
    near_real h;                // [s] length of the substep
    int number, count;          // of the substep, and how many the cluster takes
    int finer;                  // of these, in place of one of the world's
    bool first, first_sweep;    // substep; sweep of a stage
    const pl_substep_row *row;  // that runs
    struct pl_solving *solving; // what only the solver's own rows need (solver/substep.h)
};

// Which of `count` records, by rising slot, are of the substep's cluster: [B] of a record and to its slot.
pl_share pl_substep_share(const void *records, size_t size, size_t offset, uint32_t count,
                          const pl_substep *s);

#endif
