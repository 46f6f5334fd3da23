// heat_list.h - records of bodies that have heat, or grow: below the API.
#ifndef PL_HEAT_LIST_H
#define PL_HEAT_LIST_H

#include "world/state.h"

// Its record; NULL: it has none.
pl_heat *pl_heat_find(const plumb_world *world, plumb_body body);
// The same, or the defaults.
pl_heat pl_heat_get(const plumb_world *world, plumb_body body);
// Room for so many more records.
bool pl_heat_reserve(plumb_world *world, uint32_t extra);
void pl_heats_free(pl_memory *memory, pl_heats *heats);
// Gives the body of `values` them; all defaults: takes its record away. Room must be reserved.
void pl_heat_set(plumb_world *world, const pl_heat *values);
// A body that is made: what its descriptor asks for, and whether that is anything.
pl_heat pl_heat_of_desc(const plumb_body_desc *desc);
bool pl_heat_is_any(const pl_heat *values);
// The body goes.
void pl_heat_forget(plumb_world *world, plumb_body body);

// What another has of the mass `mass` [kg] becomes that of a body of mass `own`; before the other goes.
void pl_heat_merge(plumb_world *world, plumb_body body, double own, plumb_body other, double mass);
// A body that is a share of what another was; both have records, or none.
void pl_heat_share(plumb_world *world, plumb_body part, const pl_heat *whole, double share);

// [J] of a body of mass `mass` [kg].
double pl_heat_content(const pl_heat *heat, double mass);

#endif
