// impact_gap.h - how far two shapes are apart, found by brute force from their pieces and poses alone: what the
// observer of impacts looks at.
#ifndef STABILITY_IMPACT_GAP_H
#define STABILITY_IMPACT_GAP_H

#include "plumb/plumb.h"

// [m] between the nearest points of two shapes; 0 where they overlap.
double impact_gap(const plumb_world *w, plumb_shape a, plumb_shape b);

#endif
