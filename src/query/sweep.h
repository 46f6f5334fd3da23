// sweep.h - one convex shape moved along a line against another: when they meet, and how deep they
// overlap.
//
// Both are put into one: the sum of the fixed shape and the mirrored mover is the set of all places
// of the mover at which the two overlap (Minkowski difference; Lozano-Perez 1983 calls it the
// configuration space obstacle). The mover is a point to it, so a cast is a ray, exact to the
// rounding of doubles, without iteration.
#ifndef PL_SWEEP_H
#define PL_SWEEP_H

#include "query/overlap.h"

#define PL_SUM_MOST (2 * PLUMB_POLYGON_MAX_VERTICES)

// Places of a mover, relative to where it is now, at which its core overlaps a fixed core: corners
// counter-clockwise, one for two points, two for parallel lines. The shapes overlap within `radius`
// of it.
typedef struct pl_sum {
    double x[PL_SUM_MOST], y[PL_SUM_MOST];   // [m]
    double nx[PL_SUM_MOST], ny[PL_SUM_MOST]; // outward unit normal of edge i to i + 1
    int count;
    double radius; // [m]
} pl_sum;

void pl_sum_make(const pl_round *fixed, const pl_round *mover, pl_sum *out);

// How far a place of the mover is from touching (negative: how deep it overlaps) and the outward
// unit normal of the sum that is nearest.
typedef struct pl_sum_near {
    double distance; // [m]
    double nx, ny;
} pl_sum_near;

pl_sum_near pl_sum_nearest(const pl_sum *sum, double x, double y);

// Where a mover at (x, y) first meets the sum on its way by (dx, dy). One that overlaps it by more
// than `touch` [m] meets it at once, wherever it goes; one that only touches it, if it approaches.
typedef struct pl_sum_hit {
    double fraction; // [-] 0..1 of the way
    double nx, ny;   // outward unit normal of the sum
    double depth;    // [m] of the overlap at the start; 0: none
} pl_sum_hit;

bool pl_sum_cast(const pl_sum *sum, double x, double y, double dx, double dy, double touch,
                 pl_sum_hit *hit);

// Where the two touch when the mover has been moved by (dx, dy) and (nx, ny) is the normal between
// them, out of the fixed one: on the surface of that, midway where they share a stretch.
void pl_round_touch(const pl_round *fixed, const pl_round *mover, double dx, double dy, double nx,
                    double ny, double *x, double *y);
// The same where an edge counts as lying in the contact only if it leans less than `flat` [-].
void pl_round_touch_within(const pl_round *fixed, const pl_round *mover, double dx, double dy,
                           double nx, double ny, double flat, double *x, double *y);

#endif
