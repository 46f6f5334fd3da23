// revolute.c - hinge: the anchors coincide. Value: the turn of B relative to A [rad].
#include "joints/parts.h"

static void rows(const pl_joint *j, const pl_joint_pose *a, const pl_joint_pose *b, pl_rows *out)
{
    pl_row angle = pl_row_angle(a, b, 0);
    pl_rows_point(out, a, b, plumb_v2(0, 0));
    pl_rows_spring_limits(j, angle, &out->row[2]);
    pl_row_motor(j, angle, &out->row[5]);
    out->count = 6;
}

const pl_joint_class pl_joint_revolute = {
    .name = "revolute",
    .has = PL_JOINT_LIMIT | PL_JOINT_MOTOR | PL_JOINT_SPRING | PL_JOINT_REST | PL_JOINT_RADIANS |
           PL_JOINT_REFERENCE,
    .rows = rows,
    .value = pl_value_turn,
};
