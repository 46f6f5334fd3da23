// broad.h - the broad phase: which pieces may touch. Keeps fat boxes, three grids (moving, static and
// sleeping pieces) and the list of overlapping pairs, rebuilt only when a piece leaves its fat box.
#ifndef PL_BROAD_H
#define PL_BROAD_H

#include "broad/grid.h"
#include "broad/pair.h"

typedef struct pl_broad {
    pl_grid moving, fixed;
    pl_grid resting; // may still name pieces that sleep no more: see PL_PIECE_ASLEEP
    pl_pair_list pairs;
    pl_buffer list;   // uint32_t pieces to file
    pl_buffer found;  // pl_found: pairs of a rebuild as they come
    pl_buffer sorted; // pl_found: scratch of sorting
    pl_buffer sensed; // pl_found: sensor piece and what is near it
    uint32_t sensed_count;
    pl_buffer counts; // uint32_t, or pl_keyed a pair: scratch of sorting
    pl_buffer lost;   // uint32_t places of pairs that are no more
    uint32_t found_count;
    uint32_t serial; // newest piece serial at the last rebuild: younger slots carry nothing over
    uint64_t rebuilds;
    bool stale;     // the pair list must be made from nothing
    bool emptied;   // so many boxes were left that it had better be
    bool unfiled;   // a box was left since the moving grid was filed
    pl_buffer left; // uint32_t moving pieces whose box was made anew since the pair list was made
    pl_buffer left_marks; // uint8_t a piece slot: it is in `left`
    uint32_t left_count;
    bool moving_lost, fixed_lost, resting_lost; // the world was restored: a grid to be filed anew
    bool refreshed; // fat boxes were brought up to date in this step already
} pl_broad;

// Brings fat boxes and grids up to date with the poses; *stale tells whether the pair list no
// longer covers all that may touch within dt [s]. False when out of memory.
bool pl_broad_update_grids(plumb_world *world, real dt, bool *stale);

// The same, then rebuilds the pair list if it is stale. Touching pairs carry their impulses over.
bool pl_broad_update(plumb_world *world, real dt);

// Fat boxes of moving pieces for a step of dt [s], velocities of poses (fat.c); which have left theirs.
void pl_broad_refresh_moving(plumb_world *world, real dt);
// Room for `slots` pieces that leave their boxes. False when out of memory.
bool pl_broad_reserve_left(plumb_world *world, uint32_t slots);
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
