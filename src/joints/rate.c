// rate.c - how fast a joint's coordinate changes: J v, with the slope of the coordinate as J.
//
// Reads: one joint, poses and velocities of its bodies. Writes: nothing. Cost: O(1).
#include "world/body_settings.h"
#include "world/joint_list.h"
#include "joints/joint.h"
#include "joints/parts.h"
#include "world/check.h"
#include "world/state.h"

// Of a body; 0 of the world.
typedef struct motion {
    real vx, vy, w;
} motion;

// What moves in a time of its own moves at its own share of its velocity.
static motion motion_of(const plumb_world *world, plumb_body body)
{
    const uint32_t row = plumb_is_null(body) ? PL_NONE : pl_body_row(world, body);
    if (row == PL_NONE) {
        return (motion){ 0, 0, 0 };
    }
    const pl_bodies *b = &world->bodies;
    const real time = world->settings.scaled > 0 ? pl_time_scale(world, row) : 1;
    return (motion){ time * b->vx[row], time * b->vy[row], time * b->w[row] };
}

static real along(const plumb_world *world, const pl_joint *joint, const pl_row *slope)
{
    const motion a = motion_of(world, joint->a.body), b = motion_of(world, joint->b.body);
    const real rate = slope->ax * a.vx + slope->ay * a.vy + slope->aw * a.w + slope->bx * b.vx +
                      slope->by * b.vy + slope->bw * b.w;
    return pl_held((double)rate);
}

// Rate of its value, in the value's unit a second (rate.c).
static real rate_of(const plumb_world *world, const pl_joint *joint)
{
    const pl_joint_class *kind = pl_joint_classes[joint->desc.kind];
    pl_joint now = *joint;
    pl_joint_begin(world, &now);
    const pl_row slope = kind->slope != NULL ? kind->slope(&now, &now.pose_a, &now.pose_b)
                                             : pl_row_angle(&now.pose_a, &now.pose_b, 0);
    return along(world, joint, &slope);
}

real pl_joint_motor_rate(const plumb_world *world, const pl_joint *joint)
{
    const pl_row turn = { .aw = -1, .bw = 1 };
    const bool spins = (pl_joint_classes[joint->desc.kind]->has & PL_JOINT_SPINS) != 0;
    return spins ? along(world, joint, &turn) : rate_of(world, joint);
}

plumb_real plumb_joint_rate(const plumb_world *world, plumb_joint joint)
{
    const pl_joint *j = pl_ask_joint(world, __func__, joint);
    return j == NULL ? 0 : rate_of(world, j);
}

// The joint, if its kind has one of these; else null, and the refusal is told.
static const pl_joint *find_of(const plumb_world *world, const char *fn, plumb_joint joint,
                               unsigned has, const char *what)
{
    const pl_joint *j = pl_ask_joint(world, fn, joint);
    if (j == NULL) {
        return NULL;
    }
    if ((pl_joint_classes[j->desc.kind]->has & has) == 0) {
        pl_fail(world, PLUMB_E_STATE, fn, "joint is a %s joint; it must be of a kind that %s",
                pl_joint_classes[j->desc.kind]->name, what);
        return NULL;
    }
    return j;
}

plumb_real plumb_joint_turn_rate(const plumb_world *world, plumb_joint joint)
{
    const pl_joint *j = find_of(world, __func__, joint, PL_JOINT_RADIANS | PL_JOINT_SPINS, "turns");
    const pl_row slope = { .aw = -1, .bw = 1 };
    return j == NULL ? 0 : along(world, j, &slope);
}

plumb_real plumb_joint_travel_rate(const plumb_world *world, plumb_joint joint)
{
    const pl_joint *j = find_of(world, __func__, joint, PL_JOINT_TRAVELS, "travels");
    return j == NULL ? 0 : rate_of(world, j);
}
