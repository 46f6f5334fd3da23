// seek.h - what lies on a way: the first piece that answers, any, or all of them. Rays and casts differ only in how
// a piece is asked.
#ifndef PL_SEEK_H
#define PL_SEEK_H

#include "query/query.h"
#include "query/walk.h"

typedef struct pl_seek pl_seek;

// Asks one piece that the walk has come to; fills `hit`. What the question is about lies behind the pl_seek.
typedef bool pl_seek_meets(const pl_seek *seek, const pl_grid_entry *entry, pl_query_hit *hit);

// A query along a way. The first member of what a kind of question needs.
struct pl_seek {
    pl_query q;
    pl_walk walk;
    pl_seek_meets *meets;
    bool met;           // first, any
    pl_query_hit first; // what was met
};

// The first hit; of equal ones the deeper, then that of the lower slot. The walk ends where it lies.
bool pl_seek_first(pl_seek *seek);
// Whichever comes along first.
bool pl_seek_any(pl_seek *seek);
// Leaves one hit a shape in the query's list, by fraction, then slot.
void pl_seek_all(pl_seek *seek);

#endif
