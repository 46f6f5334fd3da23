// query_grids.h - the grids that queries search: those of the step where these still hold, else grids of their own.
//
// A query must not touch what the step goes by: which fat box a piece has decides which far pairs are listed,
// and so, in the last digits, how bodies move. So a world that is asked is, bit for bit, the world that is not.
#ifndef PL_QUERY_GRIDS_H
#define PL_QUERY_GRIDS_H

#include "broad/grid.h"

// Brings the grids up to date with where every piece is now. Free from the second time on, until something changes. False when out of
// memory. Cost: O(moving pieces), and O(pieces) to file them where they have left their boxes: once a step, and once for each
// PL_QUERY_STRAYS_MOST pieces that came, went or were moved since. For fewer, O(these).
bool pl_query_grids_update(plumb_world *world);
// The same, with nothing astray: for what goes through the grids and wants each piece once, where it is. O(pieces) where any was.
bool pl_query_grids_file_all(plumb_world *world);
// The grid to look into; after pl_query_grids_update. That of the strays only where there are any (stray_count).
const pl_grid *pl_query_grid_of(const plumb_world *world, pl_query_grid which);
// Whether the step's own grids hold all that there is, where it is now; that of what sleeps may still name pieces that sleep no
// more. Cost: O(moving pieces).
bool pl_step_grids_hold(const plumb_world *world);
void pl_query_grids_free(pl_memory *memory, pl_query_grid_set *set);

#endif
