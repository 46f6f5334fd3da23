// continuous.h - bodies that are swept in a step.
#ifndef PL_TABLE_CONTINUOUS_H
#define PL_TABLE_CONTINUOUS_H

#include "core/memory.h"
#include "world/columns.h"

// A body that moved so far in this step that it could have passed through something, or that
// something could have passed through.
typedef struct pl_mover {
    uint32_t row;
    bool beside;     // a kinematic body may have come its way
    bool stray;      // its way leaves the fat boxes with which its pieces are filed
    real x, y, c, s; // centre [m] and rotation at the start of the step
    real angle;      // [rad] it turned by, whole turns included; the last bits are not
    real moved;      // [m] no point of it moved farther
    double stop;     // [-] of the step after which it stays where it is; 1: goes all the way
} pl_mover;

typedef struct pl_continuous {
    pl_buffer movers; // pl_mover, by row; room for every dynamic and kinematic body
    uint32_t count;
    real least_slack;       // [m] of all bodies ever made
    bool noting;            // the pass will run in this step
    uint32_t stopped_count; // bodies put back to an impact in the last step
} pl_continuous;

static inline pl_mover *pl_movers(const pl_continuous *continuous)
{
    return (pl_mover *)continuous->movers.data;
}

#endif
