// filter.h - which shapes may meet: categories, groups, excluded pairs of bodies, sensors.
#ifndef PL_FILTER_H
#define PL_FILTER_H

#include "world/state.h"

// Sets or clears a flag of a piece and counts it.
void pl_piece_flag(plumb_world *world, uint32_t piece, uint8_t flag, bool on, uint32_t *counter);

plumb_result pl_filter_check(const plumb_world *world, const char *function,
                             const plumb_filter *filter);
// Writes a checked filter to all pieces of a shape and keeps up the counters.
void pl_filter_apply(plumb_world *world, uint32_t first, const plumb_filter *filter);
void pl_sensor_apply(plumb_world *world, uint32_t first, bool sensor);

// True when pair finding has to ask pl_pieces_meet or to tell sensors apart.
static inline bool pl_world_is_selective(const plumb_world *world)
{
    return world->filtered_pieces + world->sensor_pieces + world->excluded_count > 0;
}

// Filters and excluded bodies of two pieces allow that they meet.
bool pl_pieces_meet(const plumb_world *world, uint32_t p, uint32_t q);

// Whether the bodies of two rows are an excluded pair.
bool pl_rows_excluded(const plumb_world *world, uint32_t row_a, uint32_t row_b);
// A body is about to be destroyed.
void pl_exclusions_forget(plumb_world *world, uint32_t row);

// [m] a body that is found this deep in a platform, but on the side that holds, was put there.
#define PL_ONE_WAY_FOUND PL_SPECULATIVE
// Whether a one-way piece holds what comes to it where its outward unit normal, in world axes, is
// `out`, at a distance of `separation` [m] (negative: it overlaps already). Zero `out`: from inside.
// The one rule that contacts, characters, queries and continuous collision share; what a pair has
// been doing so far is in its flags, see pl_pair_passes.
bool pl_one_way_blocks(const plumb_world *world, uint32_t piece, plumb_vec2 out,
                       plumb_real separation);

#endif
