// casts.h - shades in a fluid that flows, before those of one piece are laid over one another.
#ifndef PL_CASTS_H
#define PL_CASTS_H

#include "core/sort.h"
#include "effects/fluid.h"

typedef struct pl_cast {
    uint64_t order; // immersion, then the deepest first
    double low, high, share;
} pl_cast;

// Appends those of volume `at` to effects.shelter->casts. False when out of memory.
bool pl_cast_shades(plumb_world *world, uint32_t at, uint32_t *cast_count);

#endif
