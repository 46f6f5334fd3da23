// near.h - near_real, the scalar of what is near: distances from a body's own centre, ways within a step,
// velocities, impulses, masses. Never a place in the world.
//
// It is plumb_real, but in the far build (PLUMB_FAR), where places are doubles and this is float: solver and
// narrow phase then run in float lanes. Places are subtracted from one another first, in plumb_real.
#ifndef PL_NEAR_H
#define PL_NEAR_H

#include "plumb/base.h"

#include <float.h>

#if PLUMB_REAL_IS_DOUBLE && !PLUMB_IS_FAR
typedef double near_real;
#define NEAR_EPSILON      DBL_EPSILON
#define NEAR_MAX          DBL_MAX
#define PL_NEAR_IS_DOUBLE 1
#else
typedef float near_real;
#define NEAR_EPSILON      FLT_EPSILON
#define NEAR_MAX          FLT_MAX
#define PL_NEAR_IS_DOUBLE 0
#endif

// What tells the builds apart in snapshots and recordings: 4 float, 8 double, 12 far (8 and 4).
#define PL_PRECISION ((uint32_t)(sizeof(plumb_real) + (PLUMB_IS_FAR ? sizeof(near_real) : 0)))

// The nearest real; of what is beyond all of them the largest, and 0 of what is no number.
static inline plumb_real pl_held(double value)
{
    const double most = (double)PLUMB_REAL_MAX;
    return value != value ? 0 : (plumb_real)(value > most ? most : value < -most ? -most : value);
}

#endif
