// mesh.h - an outline filled with triangles.
#ifndef PL_MESH_H
#define PL_MESH_H

#include "plumb/math.h"

#define PL_MESH_MOST 4000 // nodes

// Nodes and triangles, in doubles about the first point of the outline.
typedef struct pl_mesh {
    double spacing;
    int nodes, rim, triangles; // the first `rim` nodes lie on the outline
    double x[PL_MESH_MOST + 3], y[PL_MESH_MOST + 3];
    int corner[2 * PL_MESH_MOST + 8][3];
    int edge[6 * PL_MESH_MOST][2]; // of a hole
} pl_mesh;

// Of a simple outline, counter-clockwise, nodes `spacing` [m] apart; 0: a tenth of its longer side. False: too many nodes, or
// no triangle.
bool pl_mesh_fill(pl_mesh *m, const plumb_vec2 *points, int count, double spacing);

#endif
