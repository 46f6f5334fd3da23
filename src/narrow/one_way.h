// one_way.h - shapes that hold things on one side and let them pass from the other.
#ifndef PL_ONE_WAY_H
#define PL_ONE_WAY_H

#include "plumb/base.h"
#include "world/tables/pair.h"

// [m] one-way pieces that are nearer are one to what is under way through them, as static ones are to what slides over them.
#define PL_ONE_WAY_NEIGHBOURS 1e-3

// The pair is under way through a one-way piece: nothing may stop it until it is out.
static inline bool pl_pair_passes(const pl_pair *pair)
{
    return (pair->flags & (PL_PAIR_PASSING | PL_PAIR_DROPPING)) != 0;
}

bool pl_one_way_wanted(const plumb_world *world, const char **reason);
// Takes out the manifolds of pairs that pass, and keeps up the pairs' flags, for a step of dt [s].
void pl_one_way_run(plumb_world *world, plumb_real dt);

// The step was refused: pairs are what they were before it.
void pl_one_way_undo(plumb_world *world);
// Behind the last pass that can refuse it: nobody asks to drop through any more.
void pl_one_way_forget(plumb_world *world);

// Writes a checked property to all pieces of a shape and keeps up the counter.
void pl_one_way_apply(plumb_world *world, uint32_t first, const plumb_one_way *one_way);
plumb_result pl_one_way_check(const plumb_world *world, const char *function,
                              const plumb_one_way *one_way);

#endif
