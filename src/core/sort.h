// sort.h - sorting of small records by a key. Deterministic, in place, no allocation.
#ifndef PL_SORT_H
#define PL_SORT_H

#include <stdbool.h>
#include <stdint.h>
#include <string.h>

typedef struct pl_keyed {
    uint64_t key;
    uint32_t order; // ties: lower first
    uint32_t value; // what comes along; ties of both: lower first
} pl_keyed;

// By key, then order, then value: what the order was before decides nothing. Heap sort (Williams 1964): O(n log n) whatever the input.
void pl_sort_keyed(pl_keyed *items, uint32_t count);

// Where in a sorted array of records of `stride` bytes, each with its key first, a key stands or
// would be put. *found tells which.
uint32_t pl_find_key(const void *items, uint32_t count, uint32_t stride, uint64_t key, bool *found);

// How many there are of each kind becomes the place of the first of it, from `first` on, for sorting by
// counting. Returns the place behind the last.
uint32_t pl_counts_to_places(uint32_t *counts, uint32_t kinds, uint32_t first);

// The same of a kind that has a range for its own: `end` is how many there are; the range becomes empty, to be filled, and *at the
// place behind it.
static inline void pl_range_open(uint32_t *first, uint32_t *end, uint32_t *at)
{
    *first = *at;
    *at += *end;
    *end = *first;
}

// Two slots as one key.
static inline uint64_t pl_key(uint32_t high, uint32_t low)
{
    return (uint64_t)high << 32 | low;
}

// A number as a key: in the order that numbers have, both zeros as one.
static inline uint64_t pl_key_of_number(double v)
{
    uint64_t bits;
    v += 0.0;
    memcpy(&bits, &v, sizeof bits);
    return bits >> 63 != 0 ? ~bits : bits | UINT64_C(1) << 63;
}

// Of a pair, whichever comes first: the lower one leads.
static inline uint64_t pl_pair_key(uint32_t a, uint32_t b)
{
    return a < b ? pl_key(a, b) : pl_key(b, a);
}

#endif
