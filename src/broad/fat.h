// fat.h - how far fat boxes go beyond tight ones: what fat.c and its lanes (fat.simd.c) have in common.
#ifndef PL_FAT_H
#define PL_FAT_H

#include "world/state.h"

// A fat box goes beyond the tight one by an eighth of its size, at most 0.1 m: large enough that
// resting and slowly moving bodies do not refile, small enough that few pairs are kept in vain.
#define PL_FAT_FRACTION ((real)0.125)
#define PL_FAT_LIMIT    ((real)0.1)

// What goes farther than that in a step leaves its box in the next one anyway: it gets this part of it.
#define PL_FAT_FAST_SHARE 4

// Marks of a piece: it is in `left`, or is to be put there.
enum { PL_IN_LIST = 1, PL_JUST_LEFT = 2 };

// Makes fat boxes anew of those of moving pieces `first` to `first + count` that have left theirs, and marks them. Returns how
// many these are. Not in worlds that wrap around; places are as wide as lanes.
typedef uint32_t pl_fat_kernel(const plumb_world *world, uint32_t first, uint32_t count, real dt);
#if !PLUMB_IS_FAR
pl_fat_kernel pl_fat_refresh_w4, pl_fat_refresh_w8, pl_fat_refresh_w16;
#endif

#endif
