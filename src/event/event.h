// event.h - how the step makes contact events; the public readers are in contact_view.c.
#ifndef PL_EVENT_H
#define PL_EVENT_H

#include "broad/pair.h"

// Forgets the events of the step before.
void pl_events_clear(plumb_world *world);
// Room for `count` more end events. False when out of memory.
bool pl_events_reserve_ends(plumb_world *world, uint32_t count);
// A pair left the list: ends its touch. Room must be reserved.
void pl_pair_lost(plumb_world *world, const pl_pair *pair);
// Before the solver: room for all events of this step, approach speeds of pairs that did not touch.
bool pl_events_prepare(plumb_world *world);
// After the solver: begin and end events.
void pl_events_publish(plumb_world *world);

#endif
