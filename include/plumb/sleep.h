/// sleep.h - bodies at rest sleep: they cost nothing until something touches or changes them.
///
/// A dynamic body rests when it has been slower than plumb_world_desc.sleep_speed for sleep_time
/// and was neither speeding up nor slowing down: from one half of that time to the next, its way
/// changed by less than a fiftieth of sleep_speed * sleep_time (by default, what accelerates by 8
/// mm/s^2 stays awake), under a force that stayed the same meanwhile (see below). Bodies that
/// touch one another, come within 2 cm, or are joined make an island, with the soft bodies that touch or hang on them
/// (plumb/softbody.h); static and kinematic bodies do not connect. What is pushed out of an overlap or pulled together by a joint is as fast as its
/// place changes. When all bodies of an island rest, none touches a kinematic body that moves, and none
/// is carried along by a surface (surface_speed) or moved by the motor of a joint, however slowly,
/// they fall asleep together. But what floats, an island that touches nothing static or kinematic and is not joined
/// to such or to the world, drifts on however slowly: it falls asleep below a thousandth of sleep_speed.
/// Asleep, bodies have velocity 0, their rows are in the partition of sleeping rows,
/// no pass visits them. They keep their contacts with impulses, which go on being listed
/// (plumb_world_contacts), and queries and sensors see them. Falling asleep and waking are neither
/// begin nor end of a contact.
///
/// An island wakes as a whole, at the start of a step and before contacts are solved, when
/// - an awake body or a moving kinematic one touches it, comes within 2 cm or will in this step;
/// - one of its bodies, shapes, materials or joints is changed, or is pushed, or one is destroyed;
/// - a static or kinematic body that it touches is changed or destroyed, or a new one touches it; where a static body gets or
///   loses a shape, the shape decides, not the body: tiles may be built and dug where nobody lies on them;
/// - gravity or the tuning of contacts is changed, or a system of PLUMB_PHASE_CONTACTS is registered or
///   switched (such systems see no sleeping contacts).
/// What sets a value that is already there does not wake. Of bodies that attract each other: plumb/law.h.
///
/// Forces. A steady force lets a body at rest fall asleep, whether calls (plumb_body_apply_force) or systems that
/// write force columns give it anew each step. While it goes on, the body sleeps; when it ends, or becomes
/// another, the body wakes in that step and feels the new one. It is another when the difference would accelerate
/// the body by more than 4 * 0.02 * sleep_speed / sleep_time, 8 mm/s^2 by default (a torque: its farthest point).
/// The force is compared with the one that the body fell asleep under, so changes that creep add up.
/// A body that sleeps under no force wakes by any that a call gives it, at once.
///
/// A system that pushes bodies for longer than a moment writes the sleeping rows, too (plumb_body_span,
/// PLUMB_VIEW_DYNAMIC): then its changes wake. What it pushes when it leaves them alone wakes once, in the step
/// after it fell asleep, to see whether the force is still there; falls asleep again; and then sleeps until
/// something else wakes it or a system is switched off or on (plumb_system_enable).
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
