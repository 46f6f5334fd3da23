// cover.h - what an update does to one piece.
#ifndef PL_COVER_H
#define PL_COVER_H

#include "internal_edges/internal_edges.h"

// Finds the neighbours of a piece and stores what they cover and narrow. Grids and fat boxes must be
// up to date, and edges->corners as long as the vertex pool. False when out of memory; the piece then
// has no internal edges.
bool pl_internal_edges_find(plumb_world *world, uint32_t piece);

#endif
