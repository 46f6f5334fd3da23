// surface.h - what surfaces have beyond friction and restitution mixed by default.
#ifndef PL_SURFACE_H
#define PL_SURFACE_H

#include "world/tables/manifold.h"

// Some material in use asks for more than the default mix; *reason says so or not.
bool pl_surfaces_wanted(const plumb_world *world, const char **reason);
// Some pair's restitution may differ from the larger of the two.
bool pl_restitution_is_mixed(const plumb_world *world);
// Mixes anew: rules, pair table, rolling resistance, surface speed; then sums up.
void pl_surfaces_mix(plumb_world *world);

// The summary of the manifolds as they are now.
void pl_narrow_summarise(pl_narrow *narrow);

#endif
