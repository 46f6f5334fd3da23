// softbody_list.h - the list of soft bodies, below the API.
#ifndef PL_SOFTBODY_LIST_H
#define PL_SOFTBODY_LIST_H

#include "world/state.h"

// The row of a live handle, PL_NONE otherwise.
uint32_t pl_softbody_find(const plumb_world *world, plumb_softbody softbody);
// Soft bodies keep their order; handles of those behind it are told their new rows.
void pl_softbody_remove(plumb_world *world, uint32_t row);
// Takes a pin away, whose soft body is `row`; the others keep their order.
void pl_softbody_drop_pin(plumb_world *world, uint32_t row, uint32_t pin);
// An edge has torn or was cut: nothing bends over it any more, and where it is one of the ring, the gas is out. O(bends and ring).
void pl_softbody_tear(const pl_softbodies *all, pl_softbody *item, pl_softbody_place at,
                      const plumb_softbody_edge *torn);
// A body goes: what it holds is free.
void pl_softbodies_forget(plumb_world *world, plumb_body body);

//---- sleep -----------------------------------------------------------------------------------------
//
// Changes only take down that one is due, as with islands: a step goes by who sleeps.

// Takes down the box of one, as its nodes lie. O(nodes).
void pl_softbody_see_box(plumb_world *world, uint32_t row, pl_softbody_place at);
// Puts it to sleep where it lies.
void pl_softbody_lay(plumb_world *world, uint32_t row, pl_softbody_place at);
// It wakes: before soft bodies are gathered.
void pl_softbody_rise(plumb_world *world, uint32_t row);
// It is due, or begins to rest anew.
void pl_softbody_stir(plumb_world *world, uint32_t row);
// The same, and what sleeps and touches it wakes: it is about to be changed, or to go.
void pl_softbody_disturb(plumb_world *world, uint32_t row);
// The body of a row is changed: what it holds or may touch is stirred, where it was and where it is; a piece of it.
void pl_softbodies_stir_by(plumb_world *world, uint32_t row);
void pl_softbodies_stir_near(plumb_world *world, uint32_t piece);
void pl_softbodies_stir_all(plumb_world *world);

// Whether its box comes within `by` [m] of another.
static inline bool pl_softbody_overlaps(const pl_softbody *item, const pl_box *box, plumb_real by)
{
    return box->max_x + by >= item->low.x && box->min_x - by <= item->high.x &&
           box->max_y + by >= item->low.y && box->min_y - by <= item->high.y;
}

#endif
