// search.h - one mover: what it would pass into first on its way.
#ifndef PL_SEARCH_H
#define PL_SEARCH_H

#include "broad/grid.h"
#include "continuous/movers.h"

// A mover that is swept.
typedef struct pl_search {
    const plumb_world *world;
    const pl_mover *mover;
    pl_swept_motion motion;
    uint32_t piece; // the one whose turn it is
    pl_swept swept;
    pl_box box;      // of its way
    double reach;    // [m] of it from the pivot
    real half_width; // [m] of it
    double sunk;     // [m] how deep the body lies in static pieces at the start; < 0: not known
    double first;    // the first hit so far; only what comes before it matters
    // Among moving bodies:
    real dt;
    bool
        among_kinematic; // looks for kinematic bodies; otherwise for dynamic ones where either asks
    uint32_t partner;    // row of the body that is hit first
    pl_shift partner_shift; // [m] of the image that is hit, in a world that wraps around
    double at_x, at_y;      // [m] about where the piece is that is looked at: tells which image
} pl_search;

// A search along the mover's way, or along another one that it is given afterwards.
pl_search pl_search_of(const plumb_world *world, const pl_mover *mover);
// The first time at which it would go too deep into a static piece; 1: never.
double pl_search_still(pl_search *s);
// Calls back for pieces near a box among which are those that sleep (PL_PIECE_ASLEEP), where bodies ask not to pass through them;
// stops, and is false, where the callback is.
bool pl_search_sleepers(const plumb_world *world, pl_box box, pl_grid_visit *visit, void *context);
// The first time at which it goes too deep into a moving partner, both on their way until they stop;
// 1: never. Set `dt` and `among_kinematic` before.
double pl_search_among(pl_search *s);

#endif
