// prismatic.c - slider: B's anchor stays on a line through A's anchor that turns with A, and B does
// not turn relative to A. Value: travel along the line [m].
#include "joints/parts.h"

static plumb_result check(const plumb_world *world, const char *fn, plumb_joint_desc *desc)
{
    return pl_joint_check_axis(world, fn, desc, plumb_v2(1, 0));
}

static void rows(const pl_joint *j, const pl_joint_pose *a, const pl_joint_pose *b, pl_rows *out)
{
    plumb_vec2 axis = pl_joint_axis(j, a);
    pl_row travel = pl_row_along_axis(a, b, axis, 0);
    out->row[0] = pl_row_along_axis(a, b, plumb_vec2_left(axis), 0);
    out->row[1] = pl_row_angle(a, b, 0);
    pl_rows_spring_limits(j, travel, &out->row[2]);
    pl_row_motor(j, travel, &out->row[5]);
    out->count = 6;
    out->block = 2;
    out->block_most = PL_UNBOUNDED;
}

const pl_joint_class pl_joint_prismatic = {
    .name = "prismatic",
    .has = PL_JOINT_LIMIT | PL_JOINT_MOTOR | PL_JOINT_SPRING | PL_JOINT_TRAVELS | PL_JOINT_REST |
           PL_JOINT_AXIS | PL_JOINT_REFERENCE,
    .check = check,
    .rows = rows,
    .value = pl_value_travel,
    .slope = pl_slope_travel,
};
