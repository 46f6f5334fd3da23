// dial.h - a world with a tolerance chooses its solver and substeps by the error that it foresees and finds.
#ifndef PL_DIAL_H
#define PL_DIAL_H

#include "plumb/accuracy.h"
#include "world/state.h"

// All constants of the dial, fitted to assets/scenes/accuracy (DECISIONS.md).
typedef struct pl_dial_fit {
    double safety; // [-] of the tolerance, what is aimed at
    double turn;   // [-] angle rate of a swing, times mean acceleration over greatest speed
    double
        swing; // [-] error of the soft step in a turn by one radian, over the square of that in a substep
    double lag; // [-] error over the turn in a substep, where the whole kick comes before the drift
    double lag_time;    // [s] in which what it moves is taken to turn by `turn` at the least
    double begun;       // [rad] what has turned by less may yet go straight
    double speed_time;  // [s] in which the fastest speed is forgotten
    double push_time;   // [s] over which accelerations are averaged
    double calm_time;   // [s] in which a need of substeps is forgotten
    double least_way;   // [-] of the smallest body, in a second: slower motion is rest
    double rest_way;    // [-] of its size, in a second: a body is held by what it lies on
    double loose_share; // [-] of the tolerance, overlaps and gaps over the smallest body
    double loose_time;  // [s] over which they are averaged
    double loose_most;  // [-] substeps that are taken for them; from there on, a direct solver is
    double heavy;       // [-] a mass ratio that sweeps do not hold
    double frozen;      // [-] error over the square of the angle by which a contact turns in a step
    double graze;       // [m] by which the place of a blow is off, along the surface
    double struck; // [-] error of the bounce of a limit, over the square of the turn in a substep
    double
        rounding; // [-] of velocities, an impact of a chain: half an epsilon, and as much of what strikes back between
    uint32_t few_most; // contacts and joints: more are not solved exactly for resting alone
    int least;         // [-] substeps
    int most;          // [-] substeps: beyond, rounding of a float grows
} pl_dial_fit;

extern const pl_dial_fit pl_dial_constants;

static inline bool pl_dial_is_on(const plumb_world *world)
{
    return world->desc.tolerance > 0;
}

// What is expected by now [-].
static inline double pl_dial_error(const pl_dial *d)
{
    const double moved = d->motion + d->frozen;
    return d->rest > moved ? d->rest : moved;
}

// Forgets what was known, and begins as the world is set.
void pl_dial_reset(plumb_world *world);
// The step begins.
void pl_dial_begin(plumb_world *world, plumb_real dt);
// Settings become what was chosen.
void pl_dial_apply(plumb_world *world);
// Behind the substeps, before anything has moved: looks at what they did, and chooses for the next step. True: this one is to be
// taken anew with what was chosen.
bool pl_dial_look(plumb_world *world, plumb_real dt);

// What a step held still while it turned, and where blows were off; as shares (frozen.c).
double pl_dial_frozen(const plumb_world *world, double dt);

#endif
