// material_pair.h - what two materials have between them.
#ifndef PL_MATERIAL_PAIR_H
#define PL_MATERIAL_PAIR_H

#include "world/state.h"

typedef struct pl_material_pair {
    uint64_t key;
    plumb_material_pair value;
} pl_material_pair;

// What was set for two material rows; NULL: they are mixed.
const plumb_material_pair *pl_material_pair_of(const plumb_world *world, uint32_t row_a,
                                               uint32_t row_b);
// A material is about to be destroyed.
void pl_material_pairs_forget(plumb_world *world, uint32_t row);

#endif
