// joint_list.h - joints as lists through the bodies: found, linked, removed.
#ifndef PL_JOINT_LIST_H
#define PL_JOINT_LIST_H

#include "world/state.h"

// The slot of a live joint or PL_NONE.
uint32_t pl_joint_slot(const plumb_world *world, plumb_joint joint);
// The live joint, or the refusal told: E_HANDLE; E_NULL of a null world. `ask`: null for those.
plumb_result pl_check_joint(const plumb_world *world, const char *function, plumb_joint joint,
                            pl_joint **out);
const pl_joint *pl_ask_joint(const plumb_world *world, const char *function, plumb_joint joint);
// Unlinks a joint, gives its slot back and releases its handle.
void pl_joint_remove(plumb_world *world, uint32_t slot);
// Gives an end of a joint another body, on which its anchor lies at the same local place.
void pl_joint_rehang(plumb_world *world, uint32_t slot, pl_joint_end *end, plumb_body body);
// Both bodies of a joint are about to notice that it is another: see sleep.h.
void pl_joint_disturb(plumb_world *world, const pl_joint *joint);
// The next joint of a body in its list.
uint32_t pl_joint_next(const pl_joint *joint, plumb_body body);
// Whether a joint forbids contacts of two body rows. O(joints of `row`).
bool pl_joints_forbid(const plumb_world *world, uint32_t row, uint32_t other);
// Whether a joint forbids contacts of a body row with any other. O(joints of `row`).
bool pl_joints_part(const plumb_world *world, uint32_t row);
// Somebody looks at its reaction after every step.
static inline bool pl_joint_is_watched(const plumb_joint_desc *d)
{
    return d->break_force > 0 || d->break_torque > 0 || d->break_impulse > 0 ||
           d->event_force > 0 || d->event_torque > 0 || d->tell_impulse;
}
// Its limit gives back speed.
static inline bool pl_joint_bounces(const plumb_joint_desc *d)
{
    return d->enable_limit && d->restitution > 0;
}
// A limit that is apart and has not borne: what gives back speed is not slowed on its way there. (Others are, when they
// are relaxed, so that the next substep ends at the bound.) `relax`: behind the motion.
static inline bool pl_joint_lets_come(const pl_joint *j, int i, bool relax)
{
    const pl_row *r = &j->rows.row[i];
    return r->type == PL_ROW_LEAST && r->error > 0 && j->impulse[i] == 0 && i != j->struck &&
           (relax || (j->clear >> i & 1u) != 0) && pl_joint_bounces(&j->desc);
}
// Row of the body of an end; PL_NONE: the world.
uint32_t pl_joint_row(const plumb_world *world, const pl_joint_end *end);
// A joint came, went or lets pass what it did not: pairs, internal edges and the plan are made anew.
void pl_joint_revise(plumb_world *world, const pl_joint *joint);

#endif
