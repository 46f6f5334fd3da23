// waves_list.h - the list of surfaces with waves: dense, in the order in which they were made, with their modes.
#ifndef PL_WAVES_LIST_H
#define PL_WAVES_LIST_H

#include "world/state.h"

#define PL_WAVES_LEAST ((real)1e-3)
#define PL_WAVES_FAR   ((real)1e6)
#define PL_WAVES_MOST  1e9 // [m], [m/s] of a mode

// Of a shape; NULL: it has none.
pl_wave_surface *pl_waves_of(const plumb_world *world, plumb_shape shape);
// [m] so far around a piece bodies are looked for.
real pl_waves_reach(const plumb_world *world, uint32_t piece);
// Room for one more surface, and modes. False when out of memory.
bool pl_waves_reserve(plumb_world *world, uint32_t surfaces, uint32_t modes);
// Gives a surface so many modes: those it has stay, new ones are 0. There must be room.
void pl_waves_resize(plumb_world *world, pl_wave_surface *surface, int modes);
// The shape has no waves any more.
void pl_waves_forget(plumb_world *world, plumb_shape shape);
// Files its pieces anew, and wakes who swims in them: waves came, went or changed.
void pl_waves_refile(plumb_world *world, plumb_shape shape, bool on);
// Whether settings may be in force, defaults resolved.
bool pl_waves_desc_is_sound(const plumb_waves_desc *desc);

#endif
