// one_way.h - shapes that hold things on one side and let them pass from the other.
#ifndef PL_ONE_WAY_H
#define PL_ONE_WAY_H

#include "broad/pair.h"

// Whether a one-way piece holds what comes to it where its outward unit normal, in world axes, is
// `out`, at a distance of `separation` [m] (negative: it overlaps already). Zero `out`: from inside.
// The one rule that contacts, characters, queries and continuous collision share; what a pair has
// been doing so far is in its flags, see pl_pair_passes.
bool pl_one_way_blocks(const plumb_world *world, uint32_t piece, plumb_vec2 out,
                       plumb_real separation);

// The pair is under way through a one-way piece: nothing may stop it until it is out.
static inline bool pl_pair_passes(const pl_pair *pair)
{
    return (pair->flags & (PL_PAIR_PASSING | PL_PAIR_DROPPING)) != 0;
}

bool pl_one_way_wanted(const plumb_world *world, const char **reason);
// Takes out the manifolds of pairs that pass, and keeps up the pairs' flags.
void pl_one_way_run(plumb_world *world);

// Writes a checked property to all pieces of a shape and keeps up the counter.
void pl_one_way_apply(plumb_world *world, uint32_t first, const plumb_one_way *one_way);
plumb_result pl_one_way_check(const plumb_world *world, const char *function,
                              const plumb_one_way *one_way);

#endif
