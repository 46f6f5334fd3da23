// effects.h - what few bodies have that makes them move unlike the rest: locked axes, damping, speed
// caps, a time of their own, a target.
//
// Locked axes are flags of the body. The rest lies in two lists of records that exist only for the
// bodies that ask for it. Passes over bodies look at one flag (PL_BODY_HAS_EFFECTS) and call in here.
#ifndef PL_EFFECTS_H
#define PL_EFFECTS_H

#include "core/memory.h"
#include "world/columns.h"

// Damping, caps and time scale of a body, and whatever else a row of src/schema stores here. All defaults: it has no
// record.
#define PL_SETTINGS_MEMBER(name, initial) real name;
typedef struct pl_body_settings {
    plumb_body body;
    PL_BODY_ROWS(PL_ROW_RECORD, PL_SETTINGS_MEMBER)
    real ax, ay,
        aw; // in a step: acceleration by forces in the world's time, before damping and caps
} pl_body_settings;

typedef struct pl_body_settings_list {
    pl_buffer items; // pl_body_settings, no order
    uint32_t count;
    uint32_t damped, capped, scaled, frozen; // records that ask for it; frozen: time scale 0
} pl_body_settings_list;

// Where a kinematic body is to be in a while.
typedef struct pl_target {
    plumb_body body;
    real x, y;      // [m] origin
    plumb_rot turn; // rotation
    real left;      // [s] until then
} pl_target;

typedef struct pl_targets {
    pl_buffer items; // pl_target, in the order in which they were set
    uint32_t count;
} pl_targets;

//---- records (body_settings.c, target.c) -----------------------------------------------------------------

// The body's record as it is, or all defaults.
pl_body_settings pl_body_settings_get(const plumb_world *world, uint32_t row);
// Room for one more record.
bool pl_body_settings_reserve(plumb_world *world);
// Gives the body these values; all defaults: takes its record away. Room must be reserved.
void pl_body_settings_set(plumb_world *world, uint32_t row, const pl_body_settings *values);
// The body has no target any more.
void pl_target_forget(plumb_world *world, uint32_t row);
// Its time scale has changed: it heads for its target, if it has one, as fast as it takes now.
void pl_target_reaim(plumb_world *world, uint32_t row);
// The body goes: its records too.
void pl_body_forget(plumb_world *world, uint32_t row);

//---- in a step ------------------------------------------------------------------------------------

// Factor on the speed at which a body of this row moves.
real pl_time_scale(const plumb_world *world, uint32_t row);
// Pose velocities of bodies with a time of their own become those of the world's time.
void pl_effects_poses(plumb_world *world);
// A body of PL_BODY_HAS_EFFECTS has just got its solver slot: locks and its own time (gather.c).
void pl_effects_gather(plumb_world *world, uint32_t row, uint32_t slot);
// Before each substep of h [s], where there is damping or a cap: accelerations that include them.
bool pl_effects_resist(const plumb_world *world);
void pl_effects_substep(plumb_world *world, real h);
// A body of PL_BODY_HAS_EFFECTS has taken over what the solver made of it.
void pl_effects_take_over(plumb_world *world, uint32_t row);

// The way and the change of velocity of a body in free flight over a step.
typedef struct pl_flight {
    double x, y, angle; // [m], [rad]
    double vx, vy, w;   // [m/s], [rad/s] change
} pl_flight;

// The same as free flight in solver/finish.c for a body of PL_BODY_HAS_EFFECTS (flight.c).
pl_flight pl_effects_fly(const plumb_world *world, uint32_t row, real dt);

// After motion: who has arrived, and where to from here.
void pl_targets_arrive(plumb_world *world, real dt);

// [1/kg] along an axis (PL_BODY_LOCK_X or _Y): 0 if it is locked.
static inline real pl_unlocked(uint32_t flags, uint32_t lock, real inv_mass)
{
    return (flags & lock) != 0 ? 0 : inv_mass;
}

#endif
