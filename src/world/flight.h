// flight.h - sums that carry what rounding takes from them, and turns: for bodies in free flight.
#ifndef PL_FLIGHT_H
#define PL_FLIGHT_H

#include "plumb/math.h"
#include "world/columns.h"

// What is left of a motion that contacts and joints have damped away halves and halves until it is
// subnormal, and then costs hundreds of cycles wherever it is multiplied. Less than this counts as none:
// a turn [rad] that moves no coordinate.
#if PL_NEAR_IS_DOUBLE
#define PL_NO_TURN 1e-100
#else
#define PL_NO_TURN 1e-12f
#endif

static inline void pl_turn(pl_bodies *b, uint32_t row, real angle)
{
    if (plumb_abs(angle) > PL_NO_TURN) {
        plumb_rot q = plumb_rot_integrate((plumb_rot){ b->c[row], b->s[row] }, angle);
        b->c[row] = q.c;
        b->s[row] = q.s;
    }
}

// Adds to a value and keeps what rounding takes away for the next time (compensated summation, in
// double). Without it, an elastic ball drifts by 2e-7 of its energy a bounce in the float library. Places of
// the far build, doubles themselves, keep the error of their own sum (Knuth's two-sum): what a body does then
// does not depend on where it is. The double build keeps none: what glides for 1e6 steps is 4e-8 m off, and whatever
// looks at a place would have to look at both parts of it.
static inline void pl_add(real *value, real *low, real change)
{
#if PLUMB_IS_FAR
    real wanted = change + *low, sum = *value + wanted, part = sum - *value;
    *low = (*value - (sum - part)) + (wanted - part);
    *value = sum;
#else
    double wanted = (double)*value + ((double)change + (double)*low);
    *value = (real)wanted;
    *low = (real)(wanted - (double)*value);
#endif
}

#endif
