// span.c - covered stretches of edges. A run holds a power of two of them and returns to the free
// list of its size, so that the pool does not grow while tiles come and go.
//
// Cost: O(1) to take and give, O(n log n) to merge, O(log n) to ask.
#include "seams/span.h"

#include <string.h>

static bool earlier(const pl_span *a, const pl_span *b)
{
    return a->from < b->from || (!(b->from < a->from) && a->to < b->to);
}

// Shell sort, gaps by Ciura (2001): edges have few spans, but a floor may have thousands.
static void sort(pl_span *spans, uint32_t count)
{
    static const uint32_t gaps[] = { 3548, 1577, 701, 301, 132, 57, 23, 10, 4, 1 };
    for (size_t g = 0; g < sizeof gaps / sizeof gaps[0]; ++g) {
        for (uint32_t i = gaps[g]; i < count; ++i) {
            pl_span span = spans[i];
            uint32_t j = i;
            for (; j >= gaps[g] && earlier(&span, &spans[j - gaps[g]]); j -= gaps[g]) {
                spans[j] = spans[j - gaps[g]];
            }
            spans[j] = span;
        }
    }
}

uint32_t pl_spans_merge(pl_span *spans, uint32_t count)
{
    sort(spans, count);
    uint32_t kept = 0;
    for (uint32_t i = 0; i < count; ++i) {
        if (kept > 0 && spans[i].from <= spans[kept - 1].to) {
            spans[kept - 1].to =
                spans[i].to > spans[kept - 1].to ? spans[i].to : spans[kept - 1].to;
        } else {
            spans[kept++] = spans[i];
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

uint32_t pl_spans_take(pl_memory *memory, pl_seams *seams, uint32_t count)
{
    uint32_t c = class_of(count);
    uint32_t first = seams->span_free[c];
    if (first != 0) {
        memcpy(&seams->span_free[c], pl_seam_spans(seams) + (first - 1), sizeof first);
        return first - 1;
    }
    uint32_t run = UINT32_C(1) << c;
    if (run > PL_NONE - seams->span_used ||
        !pl_buffer_reserve(memory, &seams->spans,
                           ((size_t)seams->span_used + run) * sizeof(pl_span))) {
        return PL_NONE;
    }
    first = seams->span_used;
    seams->span_used += run;
    // The whole run, of which some may stay unused: images of equal worlds have equal bytes.
    memset(pl_seam_spans(seams) + first, 0, run * sizeof(pl_span));
    return first;
}

void pl_spans_give(pl_seams *seams, uint32_t first, uint32_t count)
{
    uint32_t c = class_of(count);
    memcpy(pl_seam_spans(seams) + first, &seams->span_free[c], sizeof first);
    seams->span_free[c] = first + 1;
}

bool pl_spans_leave_open(const pl_span *spans, uint32_t count, double low, double high)
{
    // The last stretch that begins at or before `low`.
    uint32_t begin = 0, end = count;
    while (begin < end) {
        uint32_t middle = begin + (end - begin) / 2;
        if ((double)spans[middle].from <= low) {
            begin = middle + 1;
        } else {
            end = middle;
        }
    }
    return begin == 0 || (double)spans[begin - 1].to < high;
}
