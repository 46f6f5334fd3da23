// look.h - what an update does to one piece.
#ifndef PL_LOOK_H
#define PL_LOOK_H

#include "seams/seams.h"

// Finds the neighbours of a piece and stores what they cover and narrow. Grids and fat boxes must be
// up to date, and seams->corners as long as the vertex pool. False when out of memory; the piece then
// has no seams.
bool pl_seams_look(plumb_world *world, uint32_t piece);

// Takes the seams of a piece away.
void pl_seams_clear(plumb_world *world, uint32_t piece);

#endif
