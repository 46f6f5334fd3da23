// step.h - a step of a world whose pending commands are done.
#ifndef PL_STEP_H
#define PL_STEP_H

#include "plumb/world.h"

// Moves the world on by dt [s], 0 to 1. E_MEMORY: no step was taken, and the next one may be; E_STATE: as
// plumb_world_step says.
plumb_result pl_step(plumb_world *world, plumb_real dt);

#endif
