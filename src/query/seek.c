// seek.c - see seek.h.
//
// Reads: grids, pieces. Writes: the answer, in the seek. Cost: cells under the way, a question a box met.
#include "query/seek.h"

// Of shapes that overlap at the start, the deepest.
static bool comes_first(const pl_seek *s, const pl_query_hit *hit)
{
    const pl_query_hit *first = &s->first;
    if (!s->met || hit->fraction != first->fraction) {
        return !s->met || hit->fraction < first->fraction;
    }
    if (hit->depth != first->depth) {
        return hit->depth > first->depth;
    }
    const uint32_t slot = hit->shape.entity.index, best = first->shape.entity.index;
    return slot != best ? slot < best : hit->piece < first->piece;
}

static bool keep_first(void *context, const pl_grid_entry *entry)
{
    pl_seek *s = context;
    pl_query_hit hit;
    if (pl_query_sees(&s->q, entry->piece) && s->meets(s, entry, &hit) && comes_first(s, &hit) &&
        pl_query_accepts(&s->q, hit.shape)) {
        s->met = true;
        s->first = hit;
        s->walk.limit = (double)hit.fraction;
    }
    return true;
}

// The first that comes along: the walk ends.
static bool keep_any(void *context, const pl_grid_entry *entry)
{
    pl_seek *s = context;
    s->met = pl_query_sees(&s->q, entry->piece) && s->meets(s, entry, &s->first) &&
             pl_query_accepts(&s->q, s->first.shape);
    return !s->met;
}

static bool keep_all(void *context, const pl_grid_entry *entry)
{
    pl_seek *s = context;
    pl_query_hit hit;
    return !pl_query_sees(&s->q, entry->piece) || !s->meets(s, entry, &hit) ||
           pl_query_add(&s->q, &hit);
}

static void walk(pl_seek *s, pl_grid_visit *visit)
{
    const pl_grid *grids[PL_QUERY_GRIDS];
    int count = pl_query_grids(&s->q, grids);
    s->met = false;
    for (int i = 0; i < count; ++i) {
        if (!pl_query_walk(&s->q, grids[i], &s->walk, visit, s)) {
            return;
        }
    }
}

bool pl_seek_first(pl_seek *s)
{
    walk(s, keep_first);
    return s->met;
}

bool pl_seek_any(pl_seek *s)
{
    walk(s, keep_any);
    return s->met;
}

void pl_seek_all(pl_seek *s)
{
    walk(s, keep_all);
    pl_query_one_per_shape(&s->q);
    pl_query_sort_along(&s->q);
}
