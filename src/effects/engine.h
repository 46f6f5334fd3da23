// engine.h - engines that burn fuel, as the step calls them.
#ifndef PL_ENGINE_H
#define PL_ENGINE_H

#include "effects/effects.h"
#include "world/state.h"

// Behind the graph: whose engines run in a step of dt [s]; solver bodies get the mean of their masses over it. False when out of
// memory.
bool pl_engines_find(plumb_world *world, real dt);
// As a step ends: what has burnt is gone.
void pl_engines_burn(plumb_world *world);

#endif
