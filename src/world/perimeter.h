// perimeter.h - the surface of a body: how long it is, how large what it encloses, and places on it.
#ifndef PL_PERIMETER_H
#define PL_PERIMETER_H

#include "world/state.h"

// [m] of its solid shapes with an area, inner cuts left out; shapes that overlap are counted each.
double pl_perimeter(const plumb_world *world, uint32_t row);
// [m^2] of the same.
double pl_body_area(const plumb_world *world, uint32_t row);
// [m] the place in the world at such a way [m] along it, from 0 to the perimeter.
plumb_vec2 pl_perimeter_place(const plumb_world *world, uint32_t row, double way);

#endif
