// law_list.h - the list of laws, below the API.
#ifndef PL_LAW_LIST_H
#define PL_LAW_LIST_H

#include "world/state.h"

// The row of a live handle, PL_NONE otherwise.
uint32_t pl_law_find(const plumb_world *world, plumb_law law);
// Laws keep their order; handles of those behind it are told their new rows.
void pl_law_remove(plumb_world *world, uint32_t row);
// The law of a row becomes what a descriptor without texts says, with a formula if it is of that kind; there must be room for
// it. NULL otherwise.
void pl_law_become(plumb_world *world, uint32_t row, const pl_law_data *desc,
                   const pl_law_formula *formula);
// The body of a row goes, and the laws that it carries.
void pl_laws_forget(plumb_world *world, plumb_body body);
// A body of a row leaves those that it may attract by mutual laws: they wake.
void pl_laws_miss(plumb_world *world, uint32_t row);
// What sleeps and may be acted on wakes; what rests begins anew.
void pl_law_disturb(plumb_world *world, const pl_law_data *desc);

#endif
