// marks.h - what a change of pieces leaves for the next step to see.
#ifndef PL_MARKS_H
#define PL_MARKS_H

#include "world/state.h"

// Room for the tombstones of `slots` piece slots.
bool pl_tombstones_reserve(plumb_world *world, uint32_t slots);
// A piece goes: keeps who it was if a pair may name it. Its slot and body are still as they were.
void pl_tombstone_set(plumb_world *world, uint32_t piece);
// Something static or asleep came, went or moved.
void pl_sensing_note_rest(plumb_world *world);
// Room for `slots` pieces that leave their boxes. False when out of memory.
bool pl_broad_reserve_left(plumb_world *world, uint32_t slots);

// An event: the body of a row is taken out of the step because of `pass`.
void pl_quarantine_tell(plumb_world *world, uint32_t row, const char *pass);
// Tells of a body that moved to where it has no finite state. It has been put back.
void pl_quarantine_note_lost(plumb_world *world, uint32_t row);

#endif
