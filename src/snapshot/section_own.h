// section_own.h - the sections that follow from no list: saved by hand.
#ifndef PL_SECTION_OWN_H
#define PL_SECTION_OWN_H

#include "snapshot/section.h"

// What list.h calls OWN, in order.
enum { PL_OWN_REGISTRY, PL_OWN_CORNERS, PL_OWN_TOMBSTONES, PL_OWN_SWITCHES, PL_OWN_COUNT };

// As pl_section_at, pl_section_reserve, pl_section_read of one of them.
pl_section pl_own_section(const plumb_world *world, uint32_t which);
bool pl_own_reserve(plumb_world *world, uint32_t which, uint32_t count);
void pl_own_read(plumb_world *world, uint32_t which, const char *from, uint32_t count);
// As pl_section_lend.
bool pl_own_lend(plumb_world *world, uint32_t which, void *data, uint32_t count);
// Which systems are switched off.
void pl_own_write_switches(const plumb_world *world, char *to);

// The same of components, two sections each: values, then owners.
pl_section pl_own_component(const plumb_world *world, uint32_t which);
bool pl_own_reserve_component(plumb_world *world, uint32_t which, uint32_t count);
void pl_own_read_component(plumb_world *world, uint32_t which, const char *from, uint32_t count);

#endif
