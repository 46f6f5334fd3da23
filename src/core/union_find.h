// union_find.h - which of some numbered things hang together: each is led by another of its set, the leader by itself
// (union by the lower number, with path halving: Tarjan 1983). Cost: nearly O(1) a call.
#ifndef PL_UNION_FIND_H
#define PL_UNION_FIND_H

#include <stdbool.h>
#include <stdint.h>

static inline void pl_union_reset(uint32_t *leaders, uint32_t count)
{
    for (uint32_t i = 0; i < count; ++i) {
        leaders[i] = i;
    }
}

static inline uint32_t pl_union_leader(uint32_t *leaders, uint32_t i)
{
    while (leaders[i] != i) {
        leaders[i] = leaders[leaders[i]];
        i = leaders[i];
    }
    return i;
}

// The lower of two leads both. True if they were apart.
static inline bool pl_union_join(uint32_t *leaders, uint32_t a, uint32_t b)
{
    a = pl_union_leader(leaders, a);
    b = pl_union_leader(leaders, b);
    leaders[a < b ? b : a] = a < b ? a : b;
    return a != b;
}

#endif
