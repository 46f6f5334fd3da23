// continuous.h - bodies that moved fast in a step do not pass through anything (README.md has the
// algorithm and what it promises).
#ifndef PL_CONTINUOUS_H
#define PL_CONTINUOUS_H

#include "world/tables/continuous.h"

// A place at which two pieces are about to go into each other.
typedef struct pl_impact_place {
    uint32_t piece, other; // slots; piece is of the dynamic body that is to be stopped
    double x, y;           // [m] on the surface of piece
    double nx, ny;         // unit, out of other
} pl_impact_place;

bool pl_continuous_wanted(const plumb_world *world, const char **reason);
// Room for the movers; the last thing of a step that can run out of memory.
bool pl_continuous_reserve(plumb_world *world);
void pl_continuous_run(plumb_world *world, real dt);
void pl_continuous_free(pl_memory *memory, pl_continuous *continuous);

#endif
