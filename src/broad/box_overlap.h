// box_overlap.h - which of eight filed boxes overlap one, as bits. Vectors of 16 bytes, which every machine has: runs are
// short, seldom longer than eight, so wider ones would stay half empty.
#ifndef PL_BOX_OVERLAP_H
#define PL_BOX_OVERLAP_H

#include "broad/grid.h"

#define PL_BOX_LANES  8
#define PL_BOX_VECTOR ((uint32_t)(16 / sizeof(real)))

#if PLUMB_REAL_IS_DOUBLE
typedef int64_t pl_box_mask __attribute__((vector_size(16)));
#else
typedef int32_t pl_box_mask __attribute__((vector_size(16)));
#endif
typedef real pl_box_reals __attribute__((vector_size(16)));
typedef real pl_box_loads __attribute__((vector_size(16), may_alias, aligned(sizeof(real))));

static inline uint32_t pl_box_bits(pl_box_mask mask)
{
#if defined(__SSE2__) && PLUMB_REAL_IS_DOUBLE
    return (uint32_t)__builtin_ia32_movmskpd((pl_box_reals)mask);
#elif defined(__SSE2__)
    return (uint32_t)__builtin_ia32_movmskps((pl_box_reals)mask);
#else
    uint32_t bits = 0;
    for (uint32_t i = 0; i < PL_BOX_VECTOR; ++i) {
        bits |= (uint32_t)(mask[i] & 1) << i;
    }
    return bits;
#endif
}

// A box in every lane.
typedef struct pl_box_wide {
    pl_box_reals min_x, min_y, max_x, max_y;
} pl_box_wide;

static inline pl_box_wide pl_box_wide_of(const pl_box *box)
{
    const pl_box_reals zero = { 0 };
    return (pl_box_wide){ box->min_x - zero, box->min_y - zero, box->max_x - zero,
                          box->max_y - zero };
}

// Bit k: the box of entry first + k overlaps, first + k < end.
static inline uint32_t pl_box_overlaps(const pl_grid_lanes *lanes, uint32_t first, uint32_t end,
                                       const pl_box_wide *s)
{
    uint32_t bits = 0;
    for (uint32_t k = 0; k < PL_BOX_LANES; k += PL_BOX_VECTOR) {
        const uint32_t i = first + k;
        bits |= pl_box_bits((*(const pl_box_loads *)(lanes->min_x + i) <= s->max_x) &
                            (*(const pl_box_loads *)(lanes->max_x + i) >= s->min_x) &
                            (*(const pl_box_loads *)(lanes->min_y + i) <= s->max_y) &
                            (*(const pl_box_loads *)(lanes->max_y + i) >= s->min_y))
                << k;
    }
    return end - first < PL_BOX_LANES ? bits & ((1u << (end - first)) - 1) : bits;
}

#endif
