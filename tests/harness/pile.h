// pile.h - a random heap of circles, boxes, crosses and triangles that fall, tumble and hang on one another: the
// same for the same seed; and whether two of them are in the same places, to the bit.
#ifndef HARNESS_PILE_H
#define HARNESS_PILE_H

#include "harness/sim.h"

enum { PILE_MOST = 12 }; // bodies

typedef struct pile_poses {
    int count;
    double x[PILE_MOST], y[PILE_MOST], angle[PILE_MOST], vx[PILE_MOST];
} pile_poses;

// A floor of 80 m and 2 to PILE_MOST bodies on their way down to it. Returns how many.
int pile_make(plumb_world *w, uint32_t seed, plumb_body *bodies);

pile_poses pile_poses_of(const plumb_world *w, const plumb_body *bodies, int count);

// The first body that is not where it is in the other; -1: all are.
int pile_first_apart(const pile_poses *a, const pile_poses *b);

#endif
