// told.h - events that are made as a step begins, by what a replay does not do again: commands that divide bodies, bodies
// that break, melt, burn or shrink away.
#ifndef PL_RECORD_TOLD_H
#define PL_RECORD_TOLD_H

#include "world/state.h"

// [B] that they take in a recording; 0: there are none.
size_t pl_told_bytes(const plumb_world *world);
// Writes them there, without user data.
void pl_told_write(const plumb_world *world, char *to);
// Puts those of a recording in the place of the world's. E_IMAGE: they are none that a step makes; E_MEMORY.
plumb_result pl_told_play(plumb_world *world, const char *from, size_t bytes);

#endif
