// region.h - convex polygons in double that are cut by lines: what bodies break into.
//
// Corners go counter-clockwise. An edge is known to be an inner one, between pieces of one shape, or an outer one; where a line
// cuts, the new edge is an outer one.
#ifndef PL_REGION_H
#define PL_REGION_H

#include "plumb/geometry.h"

#include <stdint.h>

// 16 corners, whose rounding has one chord each a fifteen-degree turn more, and a line from each of 63 cells around.
#define PL_REGION_MOST 112

// Chords in a whole turn of what is round: 1 - cos(pi / 24), 0.9 % of the radius, lie between arc and chord.
#define PL_REGION_CHORDS 24

typedef struct pl_region {
    int count;                                   // corners; below 3: nothing
    double x[PL_REGION_MOST], y[PL_REGION_MOST]; // [m]
    uint8_t inner[PL_REGION_MOST]; // 1: the edge from corner k to k + 1 is an inner one
} pl_region;

// The larger and the smaller of two numbers that are none but numbers.
static inline double pl_larger(double a, double b)
{
    return a > b ? a : b;
}

static inline double pl_smaller(double a, double b)
{
    return a < b ? a : b;
}

// Points with n . p <= d stay; n is of length 1.
typedef struct pl_border {
    double nx, ny;
    double d; // [m]
} pl_border;

// The polygon of a shape; its corners lie on the arcs of what is round. `inner`: bit k is edge k, of shapes of radius 0.
void pl_region_of(const plumb_convex *convex, uint32_t inner, pl_region *out);
// [m] how far a shape lies beyond the line at most; negative: not at all.
double pl_border_beyond(pl_border h, const plumb_convex *convex);
// Cuts off what is beyond the line (Sutherland and Hodgman 1974, of one line).
void pl_region_clip(pl_region *region, pl_border h);
// [m^2]
double pl_region_area(const pl_region *region);
// [m] between the farthest corners.
double pl_region_diameter(const pl_region *region);
// Leaves out corners that are nearer to others, or to the line of their neighbours, than rounding tells apart.
void pl_region_clean(pl_region *region);
// Convex polygons of at most 16 corners that cover a cleaned region; room for PL_REGION_PARTS. Edges between them are
// inner ones. Returns how many, 0 where there is no area that shapes could have.
#define PL_REGION_PARTS 8
int pl_region_parts(const pl_region *region, plumb_convex *parts, uint32_t *inner);

#endif
