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

static inline void pl_measure_most(double *most, double value)
{
    *most = value > *most ? value : *most;
}

#endif
