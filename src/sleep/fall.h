// fall.h - what the parts of falling asleep tell one another: who rests, which islands rest as a whole, lying down.
#ifndef PL_FALL_H
#define PL_FALL_H

#include "sleep/sleep.h"
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

// [m^2/s^2] of its farthest point.
static inline plumb_real pl_square_speed(const pl_bodies *b, uint32_t row)
{
    const plumb_real tip = b->w[row] * b->extent[row];
    return b->vx[row] * b->vx[row] + b->vy[row] * b->vy[row] + tip * tip;
}

//---- islands (fall.c) ----------------------------------------------------------------------------

// A contact of the last narrow phase, or one whose end event is still to come.
static inline bool pl_is_linked(const pl_pair *pair)
{
    return pair->manifold != PL_NONE || (pair->flags & PL_PAIR_TOUCHING) != 0;
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
