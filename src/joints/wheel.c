// wheel.c - B's anchor stays on a line through A's anchor that turns with A, sprung along it, and B
// turns freely or by the motor. Value: travel along the line [m].
#include "world/state.h"
#include "joints/parts.h"

static plumb_result check(const plumb_world *world, const char *fn, plumb_joint_desc *desc)
{
    return pl_joint_check_axis(world, fn, desc, pl_world_up(world));
}

static void rows(const pl_joint *j, const pl_joint_pose *a, const pl_joint_pose *b, pl_rows *out)
{
    plumb_vec2 axis = pl_joint_axis(j, a);
    out->row[0] = pl_row_along_axis(a, b, plumb_vec2_left(axis), 0);
    pl_rows_spring_limits(j, pl_row_along_axis(a, b, axis, 0), &out->row[1]);
    pl_row_motor(j, pl_row_angle(a, b, 0), &out->row[4]);
    out->count = 5;
    out->block = 1;
    out->block_most = PL_UNBOUNDED;
}

const pl_joint_class pl_joint_wheel = {
    .name = "wheel",
    .has = PL_JOINT_LIMIT | PL_JOINT_MOTOR | PL_JOINT_SPRING | PL_JOINT_TRAVELS | PL_JOINT_SPINS |
           PL_JOINT_REST | PL_JOINT_AXIS | PL_JOINT_REFERENCE,
    .check = check,
    .rows = rows,
    .value = pl_value_travel,
    .slope = pl_slope_travel,
};
