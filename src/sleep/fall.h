// fall.h - what the parts of falling asleep tell one another: who rests, which islands rest as a whole, lying down.
#ifndef PL_FALL_H
#define PL_FALL_H

#include "sleep/sleep.h"
#include "world/push.h"
#include "world/softbody_list.h"
#include "world/state.h"

//---- bodies (rest.c) ---------------------------------------------------------------------------

// Time goes on for all; `passed` [s]: the step before.
void pl_rest_pass(plumb_world *world, plumb_real passed);
// In a step that is taken anew: those that began to rest anew when a body was taken out begin now, as they would
// have, had it gone before the step.
void pl_rest_again(plumb_world *world);
// What touches an immovable body that was changed begins to rest anew.
void pl_rest_around_changed(plumb_world *world, uint32_t pair_count);
// Rested for two samples, half of sleep_time each.
bool pl_is_rested(const plumb_world *world, uint32_t row);

//---- islands (fall.c) ----------------------------------------------------------------------------
//
// Members are rows that are awake and dynamic, and behind them the soft bodies: who is a candidate has a parent.

// Of a member, in `held`.
#define PL_HELD     1u // something keeps it awake
#define PL_ANCHORED 2u // it touches, or is joined to, what is fixed

static inline uint32_t pl_sleep_members(const plumb_world *world)
{
    return world->dynamic_count + world->softbodies.count;
}

// Keeps nobody awake: static, kinematic and at rest, or the world.
bool pl_is_calm(const plumb_world *world, uint32_t row);

//---- soft bodies (soft.c) ------------------------------------------------------------------------

// Those that are candidates get their parent. Returns how many they are.
uint32_t pl_sleep_soft_candidates(plumb_world *world);
// Unites members with what soft bodies hold or touch, and holds whom one does that is no candidate.
void pl_sleep_soft_link(plumb_world *world, plumb_real dt);
// What floats is kept by its own motion.
void pl_sleep_soft_hold(plumb_world *world);
// Those with a parent lie down.
void pl_sleep_soft_lie(plumb_world *world);
// In the waking pass: soft bodies wake that something awake touches, or that hold it; islands are marked that one which is awake
// touches. False when out of memory.
bool pl_sleep_soft_wake(plumb_world *world, plumb_real dt, void (*mark)(pl_sleep *, uint32_t));
// Soft bodies wake that touch or hold bodies of the islands marked from `first` on. True if any did.
bool pl_sleep_soft_follow(plumb_world *world, plumb_real dt, uint32_t first);
// Islands are marked that soft bodies which are awake touch. False when out of memory.
bool pl_sleep_soft_mark(plumb_world *world, plumb_real dt, void (*mark)(pl_sleep *, uint32_t));

// A contact of the last narrow phase, or one whose end event is still to come, or what is under way through a one-way shape.
static inline bool pl_is_linked(const pl_pair *pair)
{
    return pair->manifold != PL_NONE ||
           (pair->flags & (PL_PAIR_TOUCHING | PL_PAIR_PASSING | PL_PAIR_DROPPING)) != 0;
}

// Body rows of a pair; false when one of its pieces has gone, changed or been disabled since the pair was made.
static inline bool pl_linked_rows(const plumb_world *world, const pl_pair *pair, uint32_t *a,
                                  uint32_t *b)
{
    const pl_pieces *p = &world->pieces;
    *a = p->body[pair->a];
    *b = p->body[pair->b];
    return p->kind[pair->a] != PL_PIECE_FREE && p->serial[pair->a] <= world->broad.serial &&
           p->kind[pair->b] != PL_PIECE_FREE && p->serial[pair->b] <= world->broad.serial &&
           p->moving[pair->a] != PL_OUT && p->moving[pair->b] != PL_OUT;
}

//---- lying down (lie.c) ----------------------------------------------------------------------------

// Room for those who have a parent, so many bodies, to lie down. False: out of memory.
bool pl_lie_reserve(plumb_world *world, uint32_t pair_count, uint32_t bodies);
// Puts everybody to sleep who has a parent; `steps`: in a step, not by a call. Room must be reserved.
void pl_lie_down(plumb_world *world, uint32_t pair_count, bool steps);
// The events of it: before they lie down.
void pl_lie_tell(plumb_world *world);
// Beside the event that comes next: what the body of a row has now (retry.c). Room must be reserved.
void pl_sleep_note_fallen(plumb_world *world, uint32_t row);

#endif
