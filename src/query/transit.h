// transit.h - the part of a line that lies in a rounded convex shape, in double.
#ifndef PL_TRANSIT_H
#define PL_TRANSIT_H

#include "query/overlap.h"

#include <stdbool.h>

// Along a line through the origin: where it comes in and where it goes out, negative: behind. Normals point out of
// the shape. Of a line of no thickness both are the crossing, and the normals face the ray's start and its end.
typedef struct pl_transit {
    double enter, leave;     // [m]
    double enter_x, enter_y; // unit
    double leave_x, leave_y; // unit
} pl_transit;

// The convex shape placed at t, its corners as seen from (x, y), the rotation made a unit one.
void pl_transit_round(const plumb_convex *convex, plumb_transform t, double x, double y,
                      pl_round *out);

// False where the line of unit direction (dx, dy) misses the shape. Rays through a corner that two shapes share do not slip
// between them.
bool pl_transit_of(const pl_round *round, double dx, double dy, pl_transit *out);

// Whether the origin is in the shape; never in a line of no thickness.
bool pl_transit_holds(const pl_round *round);

#endif
