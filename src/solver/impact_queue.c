// impact_queue.c - a binary heap of impacts, each of which knows its place.
#include "solver/impact_queue.h"

#include <string.h>

static pl_impact *impact_at(const pl_solver *s, uint32_t i)
{
    return (pl_impact *)s->impacts.data + i;
}

static uint32_t *heap_of(const pl_solver *s)
{
    return s->impact_heap.data;
}

static bool comes_before(const pl_solver *s, uint32_t i, uint32_t j)
{
    double ti = impact_at(s, i)->time, tj = impact_at(s, j)->time;
    return ti < tj || (!(tj < ti) && i < j);
}

static void settle(pl_solver *s, uint32_t place, uint32_t impact)
{
    heap_of(s)[place] = impact;
    impact_at(s, impact)->place = place;
}

// Moves an impact from a free place up, then down, to where it belongs.
static void sift(pl_solver *s, uint32_t place, uint32_t impact)
{
    const uint32_t *heap = heap_of(s);
    while (place > 0 && comes_before(s, impact, heap[(place - 1) / 2])) {
        settle(s, place, heap[(place - 1) / 2]);
        place = (place - 1) / 2;
    }
    for (;;) {
        uint32_t child = 2 * place + 1;
        if (child + 1 < s->due_count && comes_before(s, heap[child + 1], heap[child])) {
            ++child;
        }
        if (child >= s->due_count || !comes_before(s, heap[child], impact)) {
            break;
        }
        settle(s, place, heap[child]);
        place = child;
    }
    settle(s, place, impact);
}

static void take_out(pl_solver *s, uint32_t place)
{
    uint32_t last = heap_of(s)[--s->due_count];
    if (place < s->due_count) {
        sift(s, place, last);
    }
}

void pl_impact_queue_put(pl_solver *s, uint32_t impact)
{
    pl_impact *m = impact_at(s, impact);
    if (m->due) {
        sift(s, m->place != PL_NONE ? m->place : s->due_count++, impact);
    } else if (m->place != PL_NONE) {
        uint32_t place = m->place;
        m->place = PL_NONE;
        take_out(s, place);
    }
}

pl_impact *pl_impact_queue_first(const pl_solver *s)
{
    return s->due_count > 0 ? impact_at(s, heap_of(s)[0]) : NULL;
}

void pl_impact_queue_link(pl_solver *s)
{
    uint32_t *heads = s->impact_heads.data;
    memset(heads, 0xff, s->dynamic_slots * sizeof *heads);
    s->due_count = 0;
    for (uint32_t i = s->impact_count; i-- > 0;) {
        pl_impact *m = impact_at(s, i);
        uint32_t slots[2] = { m->a, m->b };
        m->place = PL_NONE;
        for (int side = 0; side < 2; ++side) {
            m->next[side] = PL_NONE;
            if (slots[side] < s->dynamic_slots) {
                m->next[side] = heads[slots[side]];
                heads[slots[side]] = i;
            }
        }
    }
}

uint32_t pl_impact_of_slot(const pl_solver *s, uint32_t slot)
{
    return ((const uint32_t *)s->impact_heads.data)[slot];
}

uint32_t pl_impact_after(const pl_solver *s, uint32_t slot, uint32_t impact)
{
    const pl_impact *m = impact_at(s, impact);
    return m->next[m->a == slot ? 0 : 1];
}
