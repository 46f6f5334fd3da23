// interval.c - covered stretches of edges. A run holds a power of two of them and returns to the free
// list of its size, so that the pool does not grow while tiles come and go.
//
// Cost: O(1) to take and give, O(n log n) to merge, O(log n) to ask.
#include "world/interval.h"

#include <string.h>

static bool earlier(const pl_interval *a, const pl_interval *b)
{
    return a->from < b->from || (!(b->from < a->from) && a->to < b->to);
}

// Shell sort, gaps by Ciura (2001): edges have few intervals, but a floor may have thousands.
static void sort(pl_interval *intervals, uint32_t count)
{
    static const uint32_t gaps[] = { 3548, 1577, 701, 301, 132, 57, 23, 10, 4, 1 };
    for (size_t g = 0; g < sizeof gaps / sizeof gaps[0]; ++g) {
        for (uint32_t i = gaps[g]; i < count; ++i) {
            pl_interval interval = intervals[i];
            uint32_t j = i;
            for (; j >= gaps[g] && earlier(&interval, &intervals[j - gaps[g]]); j -= gaps[g]) {
                intervals[j] = intervals[j - gaps[g]];
            }
            intervals[j] = interval;
        }
    }
}

uint32_t pl_intervals_merge(pl_interval *intervals, uint32_t count)
{
    sort(intervals, count);
    uint32_t kept = 0;
    for (uint32_t i = 0; i < count; ++i) {
        if (kept > 0 && intervals[i].from <= intervals[kept - 1].to) {
            intervals[kept - 1].to =
                intervals[i].to > intervals[kept - 1].to ? intervals[i].to : intervals[kept - 1].to;
        } else {
            intervals[kept++] = intervals[i];
        }
    }
    return kept;
}

static uint32_t class_of(uint32_t count)
{
    uint32_t c = 0;
    while ((UINT32_C(1) << c) < count) {
        ++c;
    }
    return c;
}

uint32_t pl_intervals_take(pl_memory *memory, pl_internal_edges *edges, uint32_t count)
{
    uint32_t c = class_of(count);
    uint32_t first = edges->interval_free[c];
    if (first != 0) {
        memcpy(&edges->interval_free[c], pl_edge_intervals(edges) + (first - 1), sizeof first);
        return first - 1;
    }
    uint32_t run = UINT32_C(1) << c;
    if (run > PL_NONE - edges->interval_used ||
        !pl_buffer_reserve(memory, &edges->intervals,
                           ((size_t)edges->interval_used + run) * sizeof(pl_interval))) {
        return PL_NONE;
    }
    first = edges->interval_used;
    edges->interval_used += run;
    // The whole run, of which some may stay unused: images of equal worlds have equal bytes.
    memset(pl_edge_intervals(edges) + first, 0, run * sizeof(pl_interval));
    return first;
}

void pl_intervals_give(pl_internal_edges *edges, uint32_t first, uint32_t count)
{
    uint32_t c = class_of(count);
    memcpy(pl_edge_intervals(edges) + first, &edges->interval_free[c], sizeof first);
    edges->interval_free[c] = first + 1;
}

bool pl_intervals_leave_open(const pl_interval *intervals, uint32_t count, double low, double high)
{
    // The last stretch that begins at or before `low`.
    uint32_t begin = 0, end = count;
    while (begin < end) {
        uint32_t middle = begin + (end - begin) / 2;
        if ((double)intervals[middle].from <= low) {
            begin = middle + 1;
        } else {
            end = middle;
        }
    }
    return begin == 0 || (double)intervals[begin - 1].to < high;
}
