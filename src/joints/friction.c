// friction.c - dry friction between B and A at the anchors: a force of at most max_force against
// sliding, a torque of at most max_torque against turning. Value: the turn of B relative to A
// [rad].
#include "joints/parts.h"

static void rows(const pl_joint *j, const pl_joint_pose *a, const pl_joint_pose *b, pl_rows *out)
{
    // Nothing is held: both are pushed where B's anchor is.
    out->row[0] = pl_row_along_axis(a, b, plumb_v2(a->c, a->s), 0);
    out->row[1] = pl_row_along_axis(a, b, plumb_v2(-a->s, a->c), 0);
    out->row[2] = pl_row_angle(a, b, 0);
    for (int i = 0; i < 3; ++i) {
        out->row[i].type = PL_ROW_DRIVE;
    }
    out->row[2].most = j->desc.max_torque;
    out->block = 2;
    out->block_most = j->desc.max_force;
    out->count = 3;
}

const pl_joint_class pl_joint_friction = { .name = "friction",
                                           .has =
                                               PL_JOINT_FORCE | PL_JOINT_TORQUE | PL_JOINT_RADIANS,
                                           .rows = rows,
                                           .value = pl_value_turn };
