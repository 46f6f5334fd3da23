// overlap.h - do two convex shapes touch?
#ifndef PL_OVERLAP_H
#define PL_OVERLAP_H

#include "plumb/geometry.h"

// A core of 1..16 points and a radius, relative to a place near both shapes.
typedef struct pl_round {
    double x[PLUMB_POLYGON_MAX_VERTICES], y[PLUMB_POLYGON_MAX_VERTICES]; // [m]
    int count;
    double radius; // [m]
} pl_round;

// The shape placed at t, as seen from `origin`. Points are used, normals are not.
void pl_round_make(const plumb_convex *convex, plumb_transform t, plumb_vec2 origin, pl_round *out);

// True when the distance of the cores is at most the sum of the radii: touching counts. In double.
bool pl_rounds_overlap(const pl_round *a, const pl_round *b);

#endif
