// space.h - what tests of fast bodies share: a world without gravity for either solver, a rod.
#ifndef STABILITY_SPACE_H
#define STABILITY_SPACE_H

#include "harness/sim.h"

#define HZ60       (1 / 60.0)
#define ROD_HALF   2.0  // [m] of a rod of 4 m x 2 cm
#define ROD_HALF_W 0.01 // [m]

static inline plumb_world *space(int solver)
{
    return sim_world(&(plumb_world_desc){ .zero_gravity = true, .solver = (plumb_solver)solver });
}

static inline const char *solver_name(int solver)
{
    return solver == PLUMB_SOLVER_PGS ? "pgs" : "soft";
}

#endif
