// measure.h - what joints do and how far they are off, while a world measures itself (step/measure.c).
#ifndef PL_JOINT_MEASURE_H
#define PL_JOINT_MEASURE_H

#include "joints/joint.h"
#include "world/tables/measure.h"

// What a row's impulse counts as.
static inline plumb_work pl_joint_work(plumb_joint_kind kind, pl_row_type type, bool spring)
{
    if (spring) {
        return PLUMB_WORK_SPRINGS;
    }
    if (type == PL_ROW_DRIVE) {
        return kind == PLUMB_FRICTION ? PLUMB_WORK_FRICTION : PLUMB_WORK_MOTORS;
    }
    return kind == PLUMB_MOTOR ? PLUMB_WORK_MOTORS : PLUMB_WORK_JOINTS;
}

// Before a row: copies of impulses into the world's, for the context's group; behind it: what they did.
void pl_joints_keep(const pl_joint_context *context, uint32_t thread);
void pl_joints_measure(const pl_joint_context *context, pl_measuring *m);
// Room for the copies. False when out of memory.
bool pl_joints_measure_reserve(plumb_world *world);
// How far the rigid rows of a joint are off, [m] and [rad], where its bodies are: the root of the sum of squares.
plumb_real pl_joint_off(const plumb_world *world, const pl_joint *joint);
// Errors of joints that are awake, where their bodies are.
void pl_joints_errors(const plumb_world *world, plumb_measures *m);

#endif
