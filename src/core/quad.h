// quad.h - four numbers at a time, on the vector extensions of GCC and Clang, for loops over columns and solver
// bodies that are compiled once. Not to be passed to functions: how that is done depends on the machine.
#ifndef PL_QUAD_H
#define PL_QUAD_H

#include "core/near.h"

#include <stdint.h>

// Vectors larger than a register of the machine are aligned as one of those in the amalgamation: of others GCC would
// say there how it passes them, which only the command line can silence. They are passed to inline functions alone.
#ifdef PL_AMALGAMATED
#define PL_REGISTER(bytes) aligned(bytes), may_alias
#else
#define PL_REGISTER(bytes)
#endif

typedef plumb_real pl_quad
    __attribute__((vector_size(4 * sizeof(plumb_real)), PL_REGISTER(16), may_alias));
typedef near_real pl_near_quad
    __attribute__((vector_size(4 * sizeof(near_real)), PL_REGISTER(16), may_alias));

// Masks as wide: 0 or -1.
#if PLUMB_REAL_IS_DOUBLE
typedef int64_t pl_quad_mask
    __attribute__((vector_size(4 * sizeof(int64_t)), PL_REGISTER(16), may_alias));
#else
typedef int32_t pl_quad_mask
    __attribute__((vector_size(4 * sizeof(int32_t)), PL_REGISTER(16), may_alias));
#endif
#if PL_NEAR_IS_DOUBLE
typedef int64_t pl_near_mask
    __attribute__((vector_size(4 * sizeof(int64_t)), PL_REGISTER(16), may_alias));
#else
typedef int32_t pl_near_mask
    __attribute__((vector_size(4 * sizeof(int32_t)), PL_REGISTER(16), may_alias));
#endif

#endif
