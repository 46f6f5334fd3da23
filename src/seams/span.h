// span.h - covered stretches of edges: sorted runs in a pool.
#ifndef PL_SPAN_H
#define PL_SPAN_H

#include "seams/seams.h"

// Sorts stretches and joins those that overlap or touch; returns how many are left.
uint32_t pl_spans_merge(pl_span *spans, uint32_t count);

// A run for `count` stretches, PL_NONE when out of memory; gives one back.
uint32_t pl_spans_take(pl_memory *memory, pl_seams *seams, uint32_t count);
void pl_spans_give(pl_seams *seams, uint32_t first, uint32_t count);

// True when some of [low, high] is in none of the stretches.
bool pl_spans_leave_open(const pl_span *spans, uint32_t count, double low, double high);

#endif
