// drag.h - drag of still air, as the step calls it.
#ifndef PL_DRAG_H
#define PL_DRAG_H

#include "effects/effects.h"
#include "world/state.h"

// Behind the graph: who of the solver's bodies has drag. False when out of memory.
bool pl_drag_find(plumb_world *world);

#endif
