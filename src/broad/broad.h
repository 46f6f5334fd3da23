// broad.h - the broad phase: which pieces may touch. Keeps fat boxes, three grids (moving, static and
// sleeping pieces) and the list of overlapping pairs, rebuilt only when a piece leaves its fat box.
#ifndef PL_BROAD_H
#define PL_BROAD_H

#include "world/tables/broad.h"
#include "broad/grid.h"

// Brings fat boxes and grids up to date with the poses; *stale tells whether the pair list no
// longer covers all that may touch within dt [s]. False when out of memory.
bool pl_broad_update_grids(plumb_world *world, real dt, bool *stale);

// Who is told of pairs that leave the list; event.h has the one of the step.
typedef struct pl_pair_listener {
    bool (*reserve)(plumb_world *world, uint32_t count); // room for the loss of so many
    void (*lost)(plumb_world *world, const pl_pair *pair);
} pl_pair_listener;

// The same, then rebuilds the pair list if it is stale. Touching pairs carry their impulses over.
bool pl_broad_update(plumb_world *world, real dt, const pl_pair_listener *listener);

// Fat boxes of moving pieces for a step of dt [s], velocities of poses (fat.c); which have left theirs.
void pl_broad_refresh_moving(plumb_world *world, real dt);
// Marks those in `left`, after a restore.
void pl_broad_mark_left(pl_broad *broad);
// No piece has left its box.
void pl_broad_forget_left(pl_broad *broad);
// The pair list no longer covers all that may touch.
static inline bool pl_broad_is_stale(const pl_broad *broad)
{
    return broad->stale || broad->left_count > 0;
}
// Fat boxes and grid of sleeping pieces, where they changed. False when out of memory.
bool pl_broad_update_resting(plumb_world *world);

void pl_broad_free(pl_memory *memory, pl_broad *broad);

#endif
