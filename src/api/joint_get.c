// joint_get.c - questions to joints. On a bad handle: zeros, and a refusal in the log. Reads: one joint and its bodies. Cost:
// O(1), lists O(joints).
#include "world/joint_list.h"
#include "joints/joint.h"
#include "joints/measure.h"
#include "plumb/math.h"
#include "world/check.h"
#include "world/state.h"

#include <math.h>

bool plumb_joint_valid(const plumb_world *world, plumb_joint joint)
{
    return pl_joint_slot(world, joint) != PL_NONE;
}

// plumb_joint_<name>: what is told of a live joint; zeros for others.
#define GETTER(type, name, value)                                                                  \
    type plumb_joint_##name(const plumb_world *world, plumb_joint joint)                           \
    {                                                                                              \
        const pl_joint *j = pl_ask_joint(world, __func__, joint);                                  \
        return j == NULL ? (type){ 0 } : (value);                                                  \
    }

GETTER(bool, is_enabled, !j->desc.disabled)
GETTER(plumb_joint_kind, get_kind, j->desc.kind)
GETTER(plumb_body, body_a, j->a.body)
GETTER(plumb_body, body_b, j->b.body)
GETTER(plumb_vec2, anchor_a, pl_joint_anchor(world, &j->a))
GETTER(plumb_vec2, anchor_b, pl_joint_anchor(world, &j->b))
GETTER(plumb_vec2, force, j->force)
GETTER(plumb_real, torque, j->torque)

// The joint, if what it gives is summed.
static const pl_joint *ask_sums(const plumb_world *world, const char *fn, plumb_joint joint)
{
    const pl_joint *j = pl_ask_joint(world, fn, joint);
    if (j != NULL && !pl_joint_is_watched(&j->desc)) {
        pl_fail(
            world, PLUMB_E_STATE, fn,
            "joint does not sum what it gives; set tell_impulse, or a bound of breaking or strain");
        return NULL;
    }
    return j;
}

plumb_vec2 plumb_joint_impulse(const plumb_world *world, plumb_joint joint)
{
    const pl_joint *j = ask_sums(world, __func__, joint);
    return j != NULL ? j->told_impulse : plumb_v2(0, 0);
}

plumb_real plumb_joint_angular_impulse(const plumb_world *world, plumb_joint joint)
{
    const pl_joint *j = ask_sums(world, __func__, joint);
    return j != NULL ? j->told_turn : 0;
}

GETTER(void *, user_data, j->desc.user_data)

const char *plumb_joint_kind_name(plumb_joint_kind kind)
{
    return (unsigned)kind < (unsigned)pl_joint_class_count ? pl_joint_classes[kind]->name : NULL;
}

plumb_result plumb_joint_settings(const plumb_world *world, plumb_joint joint,
                                  plumb_joint_desc *desc)
{
    pl_joint *j;
    PL_TRY(pl_check_joint(world, __func__, joint, &j));
    PL_TRY(pl_check_pointer(world, __func__, "desc", desc));
    *desc = j->desc;
    return PLUMB_OK;
}

plumb_real plumb_joint_value(const plumb_world *world, plumb_joint joint)
{
    const pl_joint *j = pl_ask_joint(world, __func__, joint);
    if (j == NULL) {
        return 0;
    }
    pl_joint now = *j;
    pl_joint_begin(world, &now);
    return pl_held((double)pl_joint_classes[j->desc.kind]->value(&now, &now.pose_a, &now.pose_b));
}

plumb_real plumb_joint_error(const plumb_world *world, plumb_joint joint)
{
    const pl_joint *j = pl_ask_joint(world, __func__, joint);
    if (j == NULL) {
        return 0;
    }
    return pl_joint_off(world, j);
}

int plumb_world_joints(const plumb_world *world, plumb_joint *joints, int capacity)
{
    int count = 0;
    for (uint32_t i = 0; world != NULL && i < world->joints.count; ++i) {
        const pl_joint *j = &pl_joint_items(&world->joints)[i];
        if (plumb_is_null(j->entity)) {
            continue;
        }
        if (joints != NULL && count < capacity) {
            joints[count] = j->entity;
        }
        ++count;
    }
    return count;
}

int plumb_body_joints(const plumb_world *world, plumb_body body, plumb_joint *joints, int capacity)
{
    uint32_t row = pl_ask_body(world, __func__, body);
    int count = 0;
    uint32_t i = row == PL_NONE ? PL_NONE : world->bodies.first_joint[row];
    while (i != PL_NONE) {
        const pl_joint *j = &pl_joint_items(&world->joints)[i];
        if (joints != NULL && count < capacity) {
            joints[count] = j->entity;
        }
        ++count;
        i = pl_joint_next(j, body);
    }
    return count;
}
