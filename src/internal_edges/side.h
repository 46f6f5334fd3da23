// side.h - one side of a contact as ground: what its edges and corners allow.
#ifndef PL_SIDE_H
#define PL_SIDE_H

#include "internal_edges/cone.h"
#include "internal_edges/internal_edges.h"

// A piece with what is kept of its internal edges; everything in the frame of its body.
typedef struct pl_side {
    const pl_vertex *corners;
    const pl_edge *edges;         // a corner each; only where a bit says so
    const pl_interval *intervals; // the pool
    uint32_t corner_bits, edge_bits;
    int count; // 0: a circle, which has no internal edges
} pl_side;

pl_side pl_side_of(const plumb_world *world, uint32_t piece);

// The feature of a side that lies farthest along the unit normal (nx, ny): an edge when the normal is
// that of the edge but for rounding, else a corner. Returns its number.
int pl_side_feature(const pl_side *side, double nx, double ny, bool *is_edge);

// True when some of edge k between `low` and `high` [m] from its start is open.
bool pl_side_edge_is_open(const pl_side *side, int k, double low, double high);

// True when corner k allows the normal.
bool pl_side_corner_allows(const pl_side *side, int k, double nx, double ny);
// True when the ground goes on flat at corner k: its one normal is that of an edge, of this piece or
// of a neighbour, which has the contact.
bool pl_side_corner_is_flat(const pl_side *side, int k);

// What the ground does at the start of edge k (corner k) or at its end (the next one).
pl_edge_end pl_side_edge_end(const pl_side *side, int k, bool at_start);

static inline int pl_side_next(const pl_side *side, int k)
{
    return k + 1 < side->count ? k + 1 : 0;
}

#endif
