// gather.h - what effects do as a body gets its solver slot, and when it takes over what the solver made of it.
#ifndef PL_GATHER_H
#define PL_GATHER_H

#include "effects/effects.h"

// A body of time scale s is in the world's time one of mass m / s^2 (time_scale.c).
void pl_time_scale_gather(plumb_world *world, uint32_t slot, near_real scale);
// And its velocity that of its own time again.
void pl_time_scale_take_over(plumb_world *world, uint32_t row, real scale);
// A velocity that contacts made is shortened to the caps (speed_cap.c).
void pl_caps_take_over(plumb_world *world, uint32_t row, const pl_body_settings *settings);

#endif
