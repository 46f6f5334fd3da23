/// sleep.h - bodies at rest sleep: they cost nothing until something touches or changes them.
///
/// A dynamic body rests when it has been slower than plumb_world_desc.sleep_speed for sleep_time
/// and was neither speeding up nor slowing down: from one half of that time to the next, its way
/// changed by less than a fiftieth of sleep_speed * sleep_time (by default, what accelerates by 8
/// mm/s^2 stays awake). A force that a system left in the columns keeps awake too. Bodies that
/// touch one another, come within 2 cm, or are joined make an island; static and kinematic bodies
/// do not connect. When all bodies of an island rest and none touches a kinematic body that moves,
/// they fall asleep together: their velocity is 0, their rows go to the partition of sleeping rows,
/// no pass visits them. They keep their contacts with impulses, which go on being listed
/// (plumb_world_contacts), and queries and sensors see them. Falling asleep and waking are neither
/// begin nor end of a contact.
///
/// An island wakes as a whole, at the start of a step and before contacts are solved, when
/// - an awake body or a moving kinematic one touches it, comes within 2 cm or will in this step;
/// - one of its bodies, shapes, materials or joints is changed, or is pushed, or one is destroyed;
/// - a static or kinematic body that it touches is changed or destroyed, or a new one touches it;
/// - gravity is changed, or a system of PLUMB_PHASE_CONTACTS is registered or switched (such systems
///   see no sleeping contacts).
/// What sets a value that is already there does not wake.
#ifndef PLUMB_SLEEP_H
#define PLUMB_SLEEP_H

#include "plumb/world.h"

PLUMB_BEGIN

/// False for a body that sleeps and has no reason yet to wake in the next step; false for a stale
/// handle. Static and kinematic bodies count as awake.
PLUMB_API bool plumb_body_is_awake(const plumb_world *world, plumb_body body);

/// Wakes the body and its island at the start of the next step, or makes it rest anew from 0 when
/// it is awake. Systems may call it: those of PLUMB_PHASE_BEGIN and FORCES wake for this step.
/// Errors: E_HANDLE.
PLUMB_API plumb_result plumb_body_wake(plumb_world *world, plumb_body body);

/// Puts the body and all that it touches or is joined to, as of the last step, to sleep at once,
/// whatever their speed. Rows move. O(contacts and joints of the world). Errors: E_HANDLE, E_STATE
/// (not dynamic; disabled; the world, or a body of the island, may not sleep), E_MEMORY, E_LOCKED.
PLUMB_API plumb_result plumb_body_sleep(plumb_world *world, plumb_body body);

/// Forbids or allows a body to fall asleep, and its island with it; forbidding wakes it.
/// Errors: E_HANDLE.
PLUMB_API plumb_result plumb_body_set_no_sleep(plumb_world *world, plumb_body body, bool no_sleep);
PLUMB_API bool plumb_body_no_sleep(const plumb_world *world, plumb_body body);

/// Switches sleeping in the world and sets its thresholds: speed [m/s], time [s], both >= 0; 0: the
/// defaults of plumb_world_desc. Switching it off wakes all. Errors: E_NULL, E_RANGE, E_NOT_FINITE.
PLUMB_API plumb_result plumb_world_set_sleep(plumb_world *world, bool allowed, plumb_real speed,
                                             plumb_real time);

/// Bodies that fell asleep in the last step, in row order; *count is set. Null when there are none.
PLUMB_API const plumb_body *plumb_world_sleep_events(const plumb_world *world, int *count);
/// Bodies that woke in the last step, island by island in the order in which they fell asleep;
/// *count is set. Null when there are none.
PLUMB_API const plumb_body *plumb_world_wake_events(const plumb_world *world, int *count);

PLUMB_END

#endif
