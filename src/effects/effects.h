// effects.h - what few bodies have that makes them move unlike the rest: locked axes, damping, speed
// caps, a time of their own, a target.
//
// Locked axes are flags of the body. The rest lies in two lists of records that exist only for the
// bodies that ask for it. Where the solver moves a body, an effect is a row of the substep that acts on a packed list
// of slots; in free flight it is a closed form over the step (flight.c).
#ifndef PL_EFFECTS_H
#define PL_EFFECTS_H

#include "world/substep.h"
#include "world/tables/effects.h"
#include "math/decay.h"

//---- records (body_settings.c, target.c) -----------------------------------------------------------------

// Its time scale has changed: it heads for its target, if it has one, as fast as it takes now.
void pl_target_reaim(plumb_world *world, uint32_t row);

//---- in a step ------------------------------------------------------------------------------------

// By systems that may run on several threads at once, each with ranges of its own; by others.
enum { PL_CALLED_SHARED = 1, PL_CALLED_ALONE = 2 };

void pl_effects_free(pl_memory *memory, pl_effects *effects);

// Before bodies get their slots: which of those of PL_BODY_HAS_EFFECTS have to be looked at.
void pl_effects_open(plumb_world *world);
// One of them has just got its solver slot: locks and its own time.
void pl_effects_gather(plumb_world *world, uint32_t row, uint32_t slot);
// A body of PL_BODY_HAS_SETTINGS has taken over what the solver made of it.
void pl_effects_take_over(plumb_world *world, uint32_t row);

// Before motion, where bodies are damped or capped: decays over a substep and the step of dt [s], and lists of
// whom the rows of the substep act on. False when out of memory.
bool pl_damping_find(plumb_world *world, real dt);
bool pl_caps_find(plumb_world *world);

// The way and the change of velocity of a body in free flight over a step.
typedef struct pl_flight {
    double x, y, angle; // [m], [rad]
    double vx, vy, w;   // [m/s], [rad/s] change
} pl_flight;

// The same as free flight in solver/finish.c for a body of PL_BODY_HAS_EFFECTS (flight.c).
pl_flight pl_effects_fly(const plumb_world *world, uint32_t row, real dt);

// After motion: who has arrived, and where to from here.
void pl_targets_arrive(plumb_world *world, real dt);

// Bodies that arrive with a velocity (track.c): of a time scale that changed; as a step begins, as it is refused, as it ends.
void pl_tracks_reaim(plumb_world *world, uint32_t row);
void pl_tracks_open(plumb_world *world, real dt);
void pl_tracks_undo(plumb_world *world);
void pl_tracks_arrive(plumb_world *world, real dt);
// Before a substep's velocities, and behind its drift.
void pl_tracks_begin(const struct pl_substep *s);
void pl_tracks_end(const struct pl_substep *s);

// Of a target: E_RANGE, E_NOT_FINITE (dt), E_STATE (the body is not kinematic).
plumb_result pl_target_check(const plumb_world *world, const char *function, uint32_t row, real dt);

// Of a velocity over a step, in a body's own time T: what is left of it is v - v drop + a way, its way
// v (way + way_low) + a way_of_a.
typedef struct pl_decay_step {
    real way, way_low; // [s] T M, and what rounding took from it
    real way_of_a;     // [s^2] T^2 K
    real drop;         // [-] 1 - E
} pl_decay_step;

// Of the record of the same place. Kept from step to step: an exponential costs more than all the rest.
typedef struct pl_damping_decay {
    real damping, angular_damping, time_scale, dt, h; // what it was made of
    bool alone;                                       // nothing but damping acts on the body
    pl_decay_step step, turn;                         // then: its free flight
    pl_decay flight, flight_turn;                     // over the step
    near_real drop, drop_turn;                        // [1/s] (1 - exp(-c h)) / h, in a substep
    near_real mean, mean_turn;                        // [-] mean of exp(-c t) over it
} pl_damping_decay;

static inline const pl_damping_decay *pl_damping_decays(const pl_effects *effects)
{
    return (const pl_damping_decay *)effects->decays.data;
}

// The decay of a body of PL_BODY_HAS_EFFECTS by its record, if nothing but damping makes it odd; else NULL.
static inline const pl_damping_decay *pl_damping_alone(const pl_effects *effects,
                                                       const pl_bodies *b, uint32_t row)
{
    if ((b->flags[row] & PL_BODY_HAS_EFFECTS) != PL_BODY_HAS_SETTINGS || !effects->damps) {
        return NULL;
    }
    const pl_damping_decay *d = pl_damping_decays(effects) + b->settings[row] - 1;
    return d->alone ? d : NULL;
}

// Free flight of such a body over the step; returns the angle by which it turned.
real pl_damping_fly(plumb_world *world, uint32_t row, const pl_damping_decay *decay);

#endif
