// walk.h - going through a grid along a segment.
#ifndef PL_WALK_H
#define PL_WALK_H

#include "broad/grid.h"

// A segment from (ox, oy) [m] that is still wanted up to `limit` of (dx, dy) [m].
typedef struct pl_walk {
    double ox, oy, dx, dy;
    double limit; // [-] 0..1; a visitor may lower it: what lies beyond is no longer visited
    double slack; // [m] boxes count as so much larger
    double half_x, half_y; // [m] the same, along one axis: half of a box that is moved along
} pl_walk;

// The segment between two points, with the slack that their rounding asks for.
pl_walk pl_walk_make(plumb_vec2 from, plumb_vec2 to);
// The same for a box [m] that is moved by a translation.
pl_walk pl_walk_make_box(plumb_aabb box, plumb_vec2 translation);

// A box around it [m].
pl_box pl_walk_box(const pl_walk *walk);

// Calls visit(context, entry) once for every entry whose box the segment meets before its limit;
// the visitor sees the walk through its context. Stops and returns false when visit does. Cost: the
// cells along the segment, about three for each row of cells that it crosses, or the entries of the
// level if that is less.
bool pl_walk_grid(const pl_grid *grid, pl_walk *walk, pl_grid_visit *visit, void *context);

// The same in one level. A segment without length and with much slack looks at a square.
bool pl_walk_level(const pl_grid *grid, const pl_grid_level *level, pl_walk *walk,
                   pl_grid_visit *visit, void *context);

#endif
