// heat.h - heat as the step calls it: between bodies, to surroundings, into melt and fire.
#ifndef PL_HEAT_H
#define PL_HEAT_H

#include "world/state.h"

// Room for what a step makes. False: out of memory.
bool pl_heat_reserve_flow(plumb_world *world);
// As a step of dt [s] ends: temperatures, what has melted, burnt, is to grow. Nothing structural: api/heat_run.c does that as
// the next one begins.
void pl_heat_flow(plumb_world *world, double dt);

#endif
