// system.h - the user's systems, kept in order of phase, then registration. Where they stand among the rows of the
// step is the schedule's (schedule.c).
#ifndef PL_SYSTEM_H
#define PL_SYSTEM_H

#include "world/tables/step.h"
#include "ecs/component.h"
#include "step/pass.h"

void pl_systems_free(pl_memory *memory, pl_systems *systems);

// True when the system would run in this step; *reason says why or why not.
bool pl_system_wanted(const plumb_world *world, const pl_system *system, const char **reason);
// Whether one of PLUMB_PHASE_CONTACTS would.
bool pl_system_sees_contacts(const plumb_world *world);
// Runs one, with the world locked by its name.
void pl_system_run(plumb_world *world, pl_system *system, plumb_real dt);

#endif
