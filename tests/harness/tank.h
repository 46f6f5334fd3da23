/// tank.h - tanks of liquid for tests, open above, with their lower left corner at (0, 0).
#ifndef HARNESS_TANK_H
#define HARNESS_TANK_H

#include "harness/sim.h"

/// A static box.
void tank_wall(plumb_world *w, double x, double y, double hx, double hy);
/// A world with a floor, two walls, and water that is not there yet.
plumb_world *tank_make(double width, double height, double spacing);
/// Water from (x0, y0) to (x1, y1), at rest.
void tank_fill(plumb_world *w, double x0, double y0, double x1, double y1);

typedef struct tank_state {
    double mean_x, mean_y; // [m]
    double rms;            // [m/s]
    double kinetic;        // [m^2/s^2] a particle
    double front;          // [m] the right-most
    int count;
} tank_state;

/// What all of its particles do.
tank_state tank_look(const plumb_world *w);

#endif
