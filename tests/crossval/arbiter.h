/// arbiter.h - the third opinion on a pair of convex shapes, in double and by brute force: along a
/// unit vector n, B lies beyond A by s(n) = min over B of n . b - max over A of n . a - radii. The
/// separation is the largest s(n); it is reached at a face normal of either core or, for cores that
/// are apart, along a line from a corner of A to one of B. All of them are tried.
#ifndef CROSSVAL_ARBITER_H
#define CROSSVAL_ARBITER_H

#include "harness/pairs.h"

/// A shape where it is, in double.
typedef struct placed {
    double x[PLUMB_POLYGON_MAX_VERTICES], y[PLUMB_POLYGON_MAX_VERTICES];
    int count;
    double radius;
    double cx, cy; // mean of the corners
} placed;

placed arbiter_place(const pair_side *side);
/// [m] by which B lies beyond A along the unit vector (nx, ny); negative: overlap.
double arbiter_beyond(const placed *a, const placed *b, double nx, double ny);
/// [m] separation, with the direction from A to B that shows it.
double arbiter_separation(const placed *a, const placed *b, double *nx, double *ny);
/// [m] from a point to the surface, negative inside.
double arbiter_distance(const placed *p, double x, double y);

#endif
