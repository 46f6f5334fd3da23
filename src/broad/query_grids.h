// query_grids.h - the grids that queries search: those of the step where these still hold, else grids of their own.
//
// A query must not touch what the step goes by: which fat box a piece has decides which far pairs are listed,
// and so, in the last digits, how bodies move. So a world that is asked is, bit for bit, the world that is not.
#ifndef PL_QUERY_GRIDS_H
#define PL_QUERY_GRIDS_H

#include "broad/grid.h"

typedef enum pl_query_grid {
    PL_QUERY_MOVING,
    PL_QUERY_RESTING,
    PL_QUERY_FIXED,
    PL_QUERY_GRID_COUNT
} pl_query_grid;

typedef struct pl_query_grid_set {
    bool fresh; // nothing has moved, come or gone since it was brought up to date
    bool owns
        [PL_QUERY_GRID_COUNT]; // the step's grid does not hold: the queries have one of their own
    pl_buffer grids;           // pl_grid [PL_QUERY_GRID_COUNT], made when the first one is needed
    pl_buffer boxes;           // pl_box a piece slot: tight boxes of what is in grids of its own
    pl_buffer list;            // uint32_t pieces to file
} pl_query_grid_set;

// Brings the grids up to date with where every piece is now. Free from the second time on, until something changes. False when out of
// memory. Cost: O(moving pieces); O(pieces) to file those that left their boxes, that came, went or were moved.
bool pl_query_grids_update(plumb_world *world);
// The grid to look into; after pl_query_grids_update.
const pl_grid *pl_query_grid_of(const plumb_world *world, pl_query_grid which);
void pl_query_grids_free(pl_memory *memory, pl_query_grid_set *set);

#endif
