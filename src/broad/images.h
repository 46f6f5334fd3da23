// images.h - grids of a world that wraps around: what is asked at the images of a box too.
//
// Every fat box is filed once, by the image of which the middle lies in the period; as a box is smaller than
// half a period, it reaches no farther than one period beyond the edges.
#ifndef PL_IMAGES_H
#define PL_IMAGES_H

#include "broad/grid.h"
#include "world/wrap.h"

// pl_grid_query in a world: entries by every image of theirs that overlaps `box`, their boxes shifted to where
// that image is. A piece may come several times if the box is larger than half a period.
bool pl_world_query(const plumb_world *world, const pl_grid *grid, pl_box box, pl_grid_visit *visit,
                    void *context);

// Images of a box, or of what lies in it, that may meet something in a grid. The count is bounded: of a box
// more than PL_IMAGES_MOST periods long, those in the middle.
#define PL_IMAGES_MOST 16
typedef struct pl_images {
    pl_shift period;
    double x0, x1, y0, y1; // [-] whole periods, both ends included; none: x1 < x0 or y1 < y0
} pl_images;
pl_images pl_images_of(const plumb_world *world, const pl_grid *grid, pl_box box);

// Pairs of entries whose boxes overlap over an edge and not without: found(context, piece, other) once for each,
// `piece` of `from`. Both may be the same grid. O(entries), plus a query for each near an edge.
typedef bool pl_pair_found(void *context, uint32_t piece, uint32_t other);
bool pl_images_pairs(const plumb_world *world, const pl_grid *from, const pl_grid *among,
                     pl_pair_found *found, void *context);
// The same of one entry, which need not be in the grid.
bool pl_images_partners(const plumb_world *world, const pl_grid_entry *entry, const pl_grid *among,
                        pl_pair_found *found, void *context);

#endif
