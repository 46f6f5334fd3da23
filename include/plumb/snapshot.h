/// snapshot.h - the state of a world as a number (hash).
///
///     if (plumb_world_hash(mine) != hash_of_the_other_player) ... // the two have parted
#ifndef PLUMB_SNAPSHOT_H
#define PLUMB_SNAPSHOT_H

#include "plumb/world.h"

PLUMB_BEGIN

/// 64 bits over all that decides later steps: every column of bodies, shapes and materials, joints,
/// contacts with their impulses, filters, settings, gravity, time, handles in use, user components,
/// pending commands. Two worlds that took the same calls have the same hash at every step, on any
/// machine, compiler and SIMD width of one precision; worlds that differ have different ones but for one
/// chance in 2^64. Not in it: user data, capacities, timers, the last error, events and contacts of
/// the last step. A component counts by its fields, or by its bytes when it was registered without
/// (padding and pointers in those would make it differ). A pending command counts by its kind, what
/// it acts on, and where to; the rest of it when it is carried out. Not cryptographic. 0 for null.
/// O(state): about 8 bytes a cycle, see src/snapshot/README.md.
PLUMB_API uint64_t plumb_world_hash(const plumb_world *world);

PLUMB_END

#endif
