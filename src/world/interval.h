// interval.h - covered stretches of edges: sorted runs in a pool.
#ifndef PL_INTERVAL_H
#define PL_INTERVAL_H

#include "world/tables/internal_edges.h"
#include "core/memory.h"

// Sorts stretches and joins those that overlap or touch; returns how many are left.
uint32_t pl_intervals_merge(pl_interval *intervals, uint32_t count);

// A run for `count` stretches, PL_NONE when out of memory; gives one back.
uint32_t pl_intervals_take(pl_memory *memory, pl_internal_edges *edges, uint32_t count);
void pl_intervals_give(pl_internal_edges *edges, uint32_t first, uint32_t count);

// True when some of [low, high] is in none of the stretches.
bool pl_intervals_leave_open(const pl_interval *intervals, uint32_t count, double low, double high);

#endif
