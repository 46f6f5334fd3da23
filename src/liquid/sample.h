// sample.h - the liquid at a place, between steps.
#ifndef PL_LIQUID_SAMPLE_H
#define PL_LIQUID_SAMPLE_H

#include "world/tables/liquid.h"

typedef struct pl_liquid_fill {
    double fill;           // [-] as plumb_liquid_sample has it
    double rise_x, rise_y; // its gradient, but for a factor
    double vx, vy;         // [m/s]
    double square;         // [m^2] distance of the nearest particle; INFINITY: none is within reach
    uint32_t phase;        // of that
} pl_liquid_fill;

// Files the particles, unless they lie as they were filed. False when out of memory.
bool pl_liquid_file(plumb_world *world);
pl_liquid_fill pl_liquid_fill_at(const pl_liquid *liquid, double x, double y);
// [m] from (x, y) along the unit direction (dx, dy) to where fill reaches 0.5; 0: it starts there; INFINITY: not within `length`.
double pl_liquid_ray_to_surface(const pl_liquid *liquid, double x, double y, double dx, double dy,
                                double length);

#endif
