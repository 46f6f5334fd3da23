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

// Images of a box, or of what lies in it, that may meet something in a grid. Along an axis they are PL_IMAGES_MOST
// at most, however long the box and however far it lies: of a longer one those nearest to the period, which hold
// every image of everything along that axis. They are counted in integers, as a double of 1e17 periods and one
// more is the same double.
#define PL_IMAGES_MOST 17
typedef struct pl_images {
    pl_shift period;
    double x0, y0;     // [-] whole periods to the first one
    int columns, rows; // how many there are
} pl_images;
pl_images pl_images_of(const plumb_world *world, const pl_grid *grid, pl_box box);
// [m] to one of them: image k of columns * rows, row by row.
static inline pl_shift pl_images_shift(const pl_images *i, int k)
{
    return (pl_shift){ (i->x0 + k % i->columns) * i->period.x,
                       (i->y0 + k / i->columns) * i->period.y };
}

// Pairs of entries whose boxes overlap over an edge and not without: found(context, piece, other) once for each,
// `piece` of `from`. Both may be the same grid. O(entries), plus a query for each near an edge.
typedef bool pl_pair_found(void *context, uint32_t piece, uint32_t other);
bool pl_images_pairs(const plumb_world *world, const pl_grid *from, const pl_grid *among,
                     pl_pair_found *found, void *context);
// The same of one entry, which need not be in the grid.
bool pl_images_partners(const plumb_world *world, const pl_grid_entry *entry, const pl_grid *among,
                        pl_pair_found *found, void *context);

#endif
