// finish.h - what finish.c and its lanes (finish.simd.c) share: bodies at the end of a step.
#ifndef PL_FINISH_H
#define PL_FINISH_H

#include "solver/solver.h"
#include "world/state.h"

// A speed [m/s, rad/s] below this counts as none: see flight.h.
#if PL_NEAR_IS_DOUBLE
#define PL_NO_SPEED 1e-150
#else
#define PL_NO_SPEED 1e-20f
#endif

// What the bodies of a share have in common.
typedef struct pl_finish {
    plumb_world *world;
    plumb_real dt;
    bool collided; // the graph was made in this step
    bool noting;
    bool orbits; // some bodies fly where laws lead them
    const near_real *residuals;
    uint32_t shares;
    struct {
        uint32_t count; // movers, noted where the share's rows begin
        bool lost;      // some body of it was
    } made[PLUMB_WORKERS_MAX];
} pl_finish;

#endif
