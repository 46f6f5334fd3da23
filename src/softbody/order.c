// order.c - in what order the unknowns of soft bodies are eliminated.
//
// The order is that of core/elimination.h, and of it the postorder of the elimination tree: what it fills in is the same, and blocks
// whose columns have the same rows are next to one another (fronts.c). While the pairs are those of the plan before, all stays as it
// is: what is kept tells nothing that the pairs do not.
//
// Reads: pairs of unknowns. Writes: places. Cost: O(fill); O(pairs) where they are the same.
#include "softbody/softbody.h"

#include <string.h>

#define WHOLE 100 // unknowns that hang together: more are cut in parts (core/dissection.h)

// The parent of a place: the first of those that its elimination fills in.
static uint32_t parent_of(const pl_elimination *e, uint32_t place)
{
    const uint32_t *entries = (const uint32_t *)e->entries.data + e->column[place];
    uint32_t first = PL_NONE;
    for (uint32_t i = 0; i < e->fill[place]; ++i) {
        first = e->rank[entries[i]] < first ? e->rank[entries[i]] : first;
    }
    return first;
}

// Children of each place, the one with the longest column last: a front goes on with it.
static void list_children(const pl_elimination *e, uint32_t *child, uint32_t *next, uint32_t *last)
{
    memset(child, 0xff, e->count * sizeof *child);
    memset(last, 0xff, e->count * sizeof *last);
    for (uint32_t k = e->count; k-- > 0;) {
        const uint32_t parent = parent_of(e, k);
        if (parent == PL_NONE) {
            continue;
        }
        uint32_t other = k;
        if (last[parent] == PL_NONE || e->fill[k] > e->fill[last[parent]]) {
            other = last[parent];
            last[parent] = k;
        }
        if (other != PL_NONE) {
            next[other] = child[parent];
            child[parent] = other;
        }
    }
}

static void take_postorder(pl_elimination *e)
{
    uint32_t *child = e->first, *next = e->length, *last = e->elements;
    uint32_t *stack = e->mark, *place = e->seen;
    list_children(e, child, next, last);
    for (uint32_t c = 0; c < e->component_count; ++c) {
        uint32_t at = e->start[c], length = 0;
        stack[length++] = e->start[c + 1] - 1;
        while (length > 0) {
            const uint32_t k = stack[length - 1];
            uint32_t below = child[k];
            if (below != PL_NONE) {
                child[k] = next[below];
            } else {
                below = last[k];
                last[k] = PL_NONE;
            }
            if (below != PL_NONE) {
                stack[length++] = below;
            } else {
                place[k] = at++;
                --length;
            }
        }
    }
    for (uint32_t v = 0; v < e->count; ++v) {
        e->rank[v] = place[e->rank[v]];
    }
}

// What is kept: how much of it there is, pairs, blocks of unknowns.
typedef struct kept {
    uint32_t unknowns, most_pairs, pairs;
} kept;

static uint32_t *kept_pairs(const pl_soft_step *s)
{
    return (uint32_t *)(void *)((kept *)s->kept.data + 1);
}

uint32_t *pl_soft_kept_blocks(const pl_soft_step *s)
{
    return kept_pairs(s) + 2 * (size_t)((const kept *)s->kept.data)->pairs;
}

bool pl_soft_order(pl_memory *memory, pl_soft_step *s, uint32_t most_pairs, bool *same)
{
    pl_elimination *e = &s->elimination;
    const kept now = { e->count, most_pairs, e->pair_count };
    const size_t pairs = 2 * sizeof(uint32_t) * (size_t)e->pair_count;
    *same = s->planned && memcmp(s->kept.data, &now, sizeof now) == 0 &&
            memcmp(kept_pairs(s), e->pairs, pairs) == 0;
    s->planned = *same; // until all is made
    if (*same) {
        return true;
    }
    e->whole = WHOLE;
    if (!pl_buffer_reserve(memory, &s->kept, sizeof now + pairs + e->count * sizeof(uint32_t)) ||
        !pl_elimination_run(memory, e, UINT32_MAX)) {
        return false;
    }
    memcpy(s->kept.data, &now, sizeof now);
    memcpy(kept_pairs(s), e->pairs, pairs);
    take_postorder(e);
    return true;
}
