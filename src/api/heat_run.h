// heat_run.h - what melts, burns and grows, as a step's commands call it.
#ifndef PL_API_HEAT_RUN_H
#define PL_API_HEAT_RUN_H

#include "world/state.h"

// What the step before has melted, burnt and is to grow becomes shapes of another size, particles and bodies that are gone, with their
// events; those of the step before are forgotten. `waits`: that alone, as in a step of dt 0, in which nothing changes. E_MEMORY: what is left
// waits for the next step.
plumb_result pl_heat_run(plumb_world *world, const char *function, bool waits);

#endif
