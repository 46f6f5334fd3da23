// sight.h - by which grids queries see: the step's where they still hold, else grids of their own.
//
// A query must not touch what the step goes by: which fat box a piece has decides which far pairs are listed,
// and so, in the last digits, how bodies move. So a world that is asked is, bit for bit, the world that is not.
#ifndef PL_SIGHT_H
#define PL_SIGHT_H

#include "broad/grid.h"

typedef enum pl_sight_grid {
    PL_SIGHT_MOVING,
    PL_SIGHT_RESTING,
    PL_SIGHT_FIXED,
    PL_SIGHT_GRIDS
} pl_sight_grid;

typedef struct pl_sight {
    bool fresh;                // nothing has moved, come or gone since it was brought up to date
    bool owns[PL_SIGHT_GRIDS]; // the step's grid does not hold: seen by one of its own
    pl_buffer grids;           // pl_grid [PL_SIGHT_GRIDS], made when the first one is needed
    pl_buffer boxes;           // pl_box a piece slot: tight boxes of what is in grids of its own
    pl_buffer list;            // uint32_t pieces to file
} pl_sight;

// Sees every piece where it is now. Free from the second time on, until something changes. False when out of
// memory. Cost: O(moving pieces); O(pieces) to file those that left their boxes, that came, went or were moved.
bool pl_sight_update(plumb_world *world);
// The grid to look into; after pl_sight_update.
const pl_grid *pl_sight_of(const plumb_world *world, pl_sight_grid which);
void pl_sight_free(pl_memory *memory, pl_sight *sight);

#endif
