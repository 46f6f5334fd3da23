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
// A body goes: what it holds is free.
void pl_softbodies_forget(plumb_world *world, plumb_body body);

#endif
