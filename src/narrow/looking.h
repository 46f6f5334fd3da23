// looking.h - what the parts of the pass for contacts ahead work on (ahead.c).
#ifndef PL_NARROW_LOOKING_H
#define PL_NARROW_LOOKING_H

#include "narrow/ahead.h"

typedef struct pl_looking {
    plumb_world *world;
    const pl_narrow_input *in;
    pl_narrow *narrow;
    pl_lookahead *ahead;
    double horizon;
    uint32_t movable; // body rows
    uint32_t *map;    // of a movable row: whether it is claimed, and its path
    pl_path *all;     // paths
    uint32_t path_count;
    uint32_t struck_count; // paths: those of bodies that are turned as the step begins
    uint32_t listed_first; // items: those before any impact was known
} pl_looking;

static inline pl_toi *pl_looking_items(const pl_lookahead *ahead)
{
    return (pl_toi *)ahead->items.data;
}

static inline pl_manifold *pl_looking_manifold(const pl_looking *l, const pl_toi *item)
{
    return &pl_manifolds(l->narrow)[item->manifold];
}

//---- turns.c: what impacts make of the ways ---------------------------------------------------------

// Impacts of claimed bodies are looked for: of others nobody will ask.
#define PL_UNCLAIMED 0u
#define PL_CLAIMED   1u // 1 + n: and it has path n

static inline void pl_looking_claim(const pl_looking *l, uint32_t row)
{
    if (row < l->movable && l->map[row] == PL_UNCLAIMED) {
        l->map[row] = PL_CLAIMED;
    }
}

static inline bool pl_looking_is_claimed(const pl_looking *l, uint32_t row)
{
    return row < l->movable && l->map[row] != PL_UNCLAIMED;
}

// Whether an impact turns it aside as the step begins.
static inline bool pl_looking_is_struck(const pl_looking *l, uint32_t row)
{
    return row < l->movable && l->map[row] > PL_CLAIMED &&
           l->map[row] - PL_CLAIMED <= l->struck_count;
}

// Whether another one does, before this time.
static inline bool pl_looking_is_turned(const pl_looking *l, uint32_t row, double before)
{
    return row < l->movable && l->map[row] > PL_CLAIMED + l->struck_count &&
           l->all[l->map[row] - PL_CLAIMED - 1].impact < before;
}

pl_motion pl_looking_flight(const pl_looking *l, uint32_t row);
pl_paths pl_looking_paths(const pl_looking *l, const pl_manifold *m);
// The first impact of each claimed body: by the contacts that are there already, then by those that were found to meet.
void pl_looking_note_strikes(pl_looking *l);
void pl_looking_note_meetings(pl_looking *l);

//---- settle.c: what becomes of the manifolds ----------------------------------------------------------

// By their verdicts.
void pl_looking_settle(const pl_looking *l);

#endif
