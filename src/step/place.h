// place.h - where the user's systems stand among the rows of the step.
#ifndef PL_PLACE_H
#define PL_PLACE_H

#include "plumb/ecs.h"
#include "step/pass.h"

// Whether such a system stands somewhere else than at the place of its phase in the step.
bool pl_system_is_placed(const plumb_system_desc *desc);
// Whether it can stand where it asks to.
plumb_result pl_place_check_system(const plumb_world *world, const char *fn,
                                   const plumb_system_desc *desc);
// Room for one more system. False when out of memory.
bool pl_place_reserve(plumb_world *world);
// Puts all systems between the rows of the table: world->schedule.places.
void pl_place_all(plumb_world *world);
// The system that runs in place of a row of the table, if it is switched on; NULL: none.
const char *pl_place_instead(const plumb_world *world, int pass);

extern const char *const pl_stage_names[PL_STAGES];

#endif
