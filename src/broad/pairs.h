// pairs.h - finding all overlapping pairs, sorting them, carrying contacts over.
#ifndef PL_PAIRS_H
#define PL_PAIRS_H

#include "broad/broad.h"
#include "core/sort.h"

typedef struct pl_found {
    uint32_t low, high; // piece slots; of broad->sensed: sensor, other
} pl_found;

// Brings the pair list up to date with the grids: around the pieces that left their boxes, or from
// nothing when the list is stale. False when out of memory; the old list then stands.
bool pl_pairs_update(plumb_world *world, const pl_pair_listener *listener);

// Adds pairs (their keys are those of pl_pair_key) whose boxes do not overlap, unless they are there; all of them are
// PL_PAIR_SOUGHT then. False when out of memory.
bool pl_pairs_seek(plumb_world *world, pl_keyed *sought, uint32_t count);
// They are so no more; those that were added stay, as if their boxes overlapped.
void pl_pairs_seek_no_more(plumb_world *world, const pl_keyed *sought, uint32_t count);
// The step is refused: those that were added go.
void pl_pairs_undo_seek(plumb_world *world, const pl_keyed *sought, uint32_t count);

// The pair of two pieces; NULL if their fat boxes do not overlap or they may not meet. O(log pairs).
pl_pair *pl_pairs_find_one(const plumb_world *world, uint32_t p, uint32_t q);

// broad->found in the order of the list.
typedef struct pl_sorted {
    const pl_found *pairs;
    uint32_t count;
    pl_by_kinds first, size;
} pl_sorted;

// False when out of memory (pair_sort.c).
bool pl_pairs_sort(plumb_world *world, pl_sorted *sorted);

// Fills broad->found with every pair of fat boxes that overlap and may collide, or with those of the
// pieces that left their boxes; broad->sensed likewise (pair_find.c).
bool pl_pairs_find(plumb_world *world);
bool pl_pairs_find_left(plumb_world *world);

// Whether moving pieces may meet one another, and static ones, as far as filters tell (filter_union.c).
void pl_filters_may_meet(const plumb_world *world, bool *meet, bool *grounded);

// A pair without a past, its rows looked up.
pl_pair pl_pair_fresh(const plumb_world *world, pl_found found);

// False for pieces of one body, those that filters, excluded pairs or joints keep apart, and sensors.
bool pl_pair_is_solid(plumb_world *world, uint32_t p, uint32_t q);

// All static pieces, into a list for which it makes room. False when out of memory.
bool pl_broad_list_fixed(plumb_world *world, pl_buffer *list, uint32_t *count);
// Fat boxes of pieces that do not move by themselves (fat.c).
void pl_broad_refresh_fixed(plumb_world *world);
void pl_broad_refresh_resting(plumb_world *world);

#endif
