// looking.h - what the parts of the pass for contacts ahead work on (ahead.c).
#ifndef PL_NARROW_LOOKING_H
#define PL_NARROW_LOOKING_H

#include "narrow/ahead.h"

// What is known of a movable body.
typedef struct pl_way {
    pl_path path;
    bool claimed; // impacts of it are looked for: of others nobody will ask
    bool struck;  // one turns it as the step begins
    bool bounces; // one that throws it back does
    bool lively;  // it has a contact that does: its way is followed from impact to impact
    bool joined;  // joints hold it: where it goes after an impact is theirs to say
    bool changed; // it is another since its contacts were looked at
    bool doubted; // what it does is not known to the end
    uint32_t row;
    uint64_t before; // digest of the way of then (turns.c)
} pl_way;

typedef struct pl_looking {
    plumb_world *world;
    const pl_narrow_input *in;
    pl_narrow *narrow;
    pl_lookahead *ahead;
    double horizon;
    uint32_t movable; // body rows
    uint32_t *map;    // of a movable row: 1 + the place of its way; 0: nobody has asked for it
    pl_way *all;      // ways
    uint32_t way_count;
    bool strikes_noted; // what turns bodies from now on are impacts that lie ahead
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

static inline pl_way *pl_looking_known(const pl_looking *l, uint32_t row)
{
    return row < l->movable && l->map[row] != 0 ? &l->all[l->map[row] - 1] : NULL;
}

// Whether an impact at this time may turn it: the first one, or where both bounce also one behind others.
static inline bool pl_looking_may_turn(const pl_looking *l, uint32_t row, double time, bool elastic)
{
    const pl_way *way = pl_looking_known(l, row);
    return way != NULL && way->claimed &&
           (way->path.turns == 0 || (elastic && !way->joined && way->path.turns < PL_TURNS &&
                                     time > way->path.time[way->path.turns - 1]));
}

// Whether an impact turns it aside as the step begins.
static inline bool pl_looking_is_struck(const pl_looking *l, uint32_t row)
{
    const pl_way *way = pl_looking_known(l, row);
    return way != NULL && way->struck;
}

// Whether its way has changed.
static inline bool pl_looking_is_changed(const pl_looking *l, uint32_t row)
{
    const pl_way *way = pl_looking_known(l, row);
    return way != NULL && way->changed;
}

// Whether an impact throws it back within the step.
static inline bool pl_looking_bounces(const pl_looking *l, uint32_t row)
{
    const pl_way *way = pl_looking_known(l, row);
    return way != NULL && way->bounces && way->path.turns > 0;
}

// Whether what a body does is not known to the end (expire.c).
static inline bool pl_looking_is_doubted(const pl_looking *l, uint32_t row)
{
    const pl_way *way = pl_looking_known(l, row);
    return way != NULL && way->doubted;
}

// Returns whether that is new.
static inline bool pl_looking_doubt(pl_looking *l, uint32_t row)
{
    pl_way *way = pl_looking_known(l, row);
    const bool is_new = way != NULL && !way->doubted;
    if (is_new) {
        way->doubted = true;
    }
    return is_new;
}

// Bodies are asked for again and again: each flight is computed once.
pl_way *pl_looking_new_way(pl_looking *l, uint32_t row);

static inline pl_way *pl_looking_way(pl_looking *l, uint32_t row)
{
    return l->map[row] != 0 ? &l->all[l->map[row] - 1] : pl_looking_new_way(l, row);
}

static inline void pl_looking_claim(pl_looking *l, uint32_t row)
{
    if (row < l->movable) {
        pl_looking_way(l, row)->claimed = true;
    }
}

extern const pl_path pl_looking_still;

// The path of a body, static ones included.
static inline const pl_path *pl_looking_path(pl_looking *l, uint32_t row)
{
    return row < l->movable ? &pl_looking_way(l, row)->path : &pl_looking_still;
}

pl_paths pl_looking_paths(pl_looking *l, const pl_manifold *m);
// Impacts of claimed bodies: by the contacts that are there already; then, made anew, by those that were found to meet
// on the ways that lead there; `again`: of bodies that are lively alone, for what others do must not hang on whether
// there are such. False when out of memory.
void pl_looking_note_strikes(pl_looking *l);
bool pl_looking_note_meetings(pl_looking *l, bool again);
// Whether two ways are the same until a time.
bool pl_looking_is_same_way(const pl_path *p, const pl_path *q, double time);

//---- expire.c: planes that cease to act --------------------------------------------------------------

void pl_looking_expire(pl_looking *l);

//---- struck.c: what impacts throw at what has no contact with it --------------------------------------

// Notes the pairs that meet on the ways that impacts turn and have no manifold. False when out of memory.
bool pl_looking_seek(pl_looking *l);

//---- settle.c: what becomes of the manifolds ----------------------------------------------------------

// By their verdicts.
void pl_looking_settle(const pl_looking *l);

#endif
