// neighbour.h - what one convex core does to a corner or an edge of another that it touches. Pure
// functions on corners in one frame.
#ifndef PL_NEIGHBOUR_H
#define PL_NEIGHBOUR_H

#include "plumb/geometry.h"
#include "internal_edges/cone.h"

// A core of 2 (a line) to 16 corners, counter-clockwise; normal k belongs to the edge that starts at
// corner k.
typedef struct pl_outline {
    int count;
    double x[PLUMB_POLYGON_MAX_VERTICES], y[PLUMB_POLYGON_MAX_VERTICES];
    double nx[PLUMB_POLYGON_MAX_VERTICES], ny[PLUMB_POLYGON_MAX_VERTICES];
} pl_outline;

// Normals of the core alone at its corner k: all between those of the two edges that meet there.
pl_cone pl_outline_cone(const pl_outline *o, int k);

// Normals that the core allows at the point (x, y); false when it does not reach there and so has no
// say. Whatever is nearer than `slop` [m] touches.
bool pl_outline_cone_at(const pl_outline *o, double x, double y, double slop, pl_cone *cone);

// What stands in front of an edge where it ends, at a corner that a neighbour shares: the face of the
// neighbour that turns up from there, and how steeply. {0}: none.
typedef struct pl_wall {
    double nx, ny;   // its outward normal
    double flatness; // [-] cosine of the angle at which it rises: the flattest counts
} pl_wall;

// Keeps the flatter of *wall and the faces of `has` (a neighbour's normals at the corner) for the edge
// of normal (nx, ny) that starts there, or ends.
void pl_wall_meet(pl_wall *wall, const pl_cone *has, double nx, double ny, bool starts);

// The stretch [*from, *to] of an edge, in metres from its start, that the core covers: what lies less
// than `slop` in front of it. False when there is none.
bool pl_outline_covers(const pl_outline *o, const pl_outline *edge_of, int edge, double slop,
                       double *from, double *to);

// [m] length of edge k.
double pl_outline_edge_length(const pl_outline *o, int k);

#endif
