// measured.h - how kernels tell what their impulses do: while a world measures itself (step/measure.c).
#ifndef PL_MEASURED_H
#define PL_MEASURED_H

#include "world/tables/measure.h"

// An impulse on the body of a slot in the row that has just run: J (v before + v behind) / 2 for each unit is its work,
// and the works of all impulses are the change of kinetic energy, in whatever order they were given.
static inline void pl_measure_push(const pl_measuring *m, uint32_t slot, double x, double y,
                                   double turn, plumb_work work)
{
    if (slot >= m->count) {
        return;
    }
    pl_measured_body *b = &m->bodies[slot];
    if (m->balances) {
        b->px += x, b->py += y, b->pw += turn;
    } else {
        b->work[work].kinetic += x * b->mean_x + y * b->mean_y + turn * b->mean_w;
        if (m->kicks) {
            b->kick[work][0] += x, b->kick[work][1] += y, b->kick[work][2] += turn;
        }
    }
}

// [J] that a body was given by what drives it: forces, effects, motors, characters.
static inline double pl_measure_driven(const pl_measured_body *b)
{
    static const plumb_work drives[] = { PLUMB_WORK_FORCES, PLUMB_WORK_FLUIDS, PLUMB_WORK_LIQUID,
                                         PLUMB_WORK_LAWS,   PLUMB_WORK_THRUST, PLUMB_WORK_SOFT,
                                         PLUMB_WORK_MOTORS, PLUMB_WORK_SYSTEMS };
    double sum = 0;
    for (size_t i = 0; i < sizeof drives / sizeof drives[0]; ++i) {
        sum += b->work[drives[i]].kinetic;
    }
    return sum;
}

static inline void pl_measure_most(double *most, double value)
{
    *most = value > *most ? value : *most;
}

#endif
