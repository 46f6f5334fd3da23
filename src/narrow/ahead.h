// ahead.h - contacts that lie ahead: a manifold is made for the moment at which the pieces meet, or pass.
#ifndef PL_NARROW_AHEAD_H
#define PL_NARROW_AHEAD_H

#include "narrow/narrow.h"
#include "narrow/toi.h"

// pl_manifold.feature of the nearest points of a later moment.
#define PL_AHEAD_FEATURE 0x80000000u

// [s] from the start of the step within which a contact may act.
double pl_ahead_horizon(const plumb_world *world, real dt);

// A share of the horizon in PL_WINDOW_UNIT, not 0.
uint8_t pl_ahead_moment(const plumb_world *world, double time);

// Looks at the candidates of `narrow`. Contacts of pieces that will not meet within the step, nor come near one
// another, are taken out; others that doubt is about are made for the moment at which the pieces meet or are nearest. False
// when out of memory. Cost: O(candidates); a sweep for each that closes its gap while it moves aside or turns.
bool pl_ahead_look(plumb_world *world, const pl_narrow_input *in, real dt, pl_narrow *narrow);

// Holds back the plane of a contact ahead so that it does not reach what passes: for what the ground makes anew from the
// places of the start of the step (internal_edges/correct.c).
void pl_ahead_hold_back(const plumb_world *world, const pl_pair *pair, real dt, pl_manifold *m);

// Room to keep what the pairs of all items had (settle.c).
bool pl_ahead_reserve_kept(pl_memory *memory, pl_lookahead *ahead);
// Gives pairs back what the kernels made of them, where a step is refused: their manifolds became those of later moments. Before
// pl_internal_edges_undo, which knows what pairs of its own had before the kernels.
void pl_ahead_undo(plumb_world *world);

// Counts separations from the start of the step again: after this no manifold is `ahead`.
void pl_ahead_settle(plumb_world *world);

// The two poses of a manifold that is `ahead`; the origin is A's centre of mass at the start of the step.
static inline const pl_pose *pl_ahead_poses(const plumb_world *world, const pl_manifold *m)
{
    return ((const pl_toi *)world->lookahead.items.data)[m->ahead].poses;
}

#endif
