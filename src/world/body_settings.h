// body_settings.h - records of what few bodies have: damping, caps, a time of their own, a target.
#ifndef PL_BODY_SETTINGS_H
#define PL_BODY_SETTINGS_H

#include "world/state.h"

// The body's record as it is, or all defaults.
pl_body_settings pl_body_settings_get(const plumb_world *world, uint32_t row);
// Room for one more record.
bool pl_body_settings_reserve(plumb_world *world);
// Gives the body these values; all defaults: takes its record away. Room must be reserved.
void pl_body_settings_set(plumb_world *world, uint32_t row, const pl_body_settings *values);
// The body has no target any more.
void pl_target_forget(plumb_world *world, uint32_t row);
// The body goes: its records too.
void pl_body_forget(plumb_world *world, uint32_t row);
// Factor on the speed at which a body of this row moves.
real pl_time_scale(const plumb_world *world, uint32_t row);
// [1/kg] along an axis (PL_BODY_LOCK_X or _Y): 0 if it is locked.
static inline real pl_unlocked(uint32_t flags, uint32_t lock, real inv_mass)
{
    return (flags & lock) != 0 ? 0 : inv_mass;
}
// Pose velocities of bodies with a time of their own become those of the world's time.
void pl_settings_of_poses(plumb_world *world);

#endif
