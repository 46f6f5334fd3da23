// rail.c - B's anchor stays on a line through A's anchor that turns with A; B turns freely. Value: travel along it [m].
#include "joints/parts.h"

static plumb_result check(const plumb_world *world, const char *fn, plumb_joint_desc *desc)
{
    return pl_joint_check_axis(world, fn, desc, plumb_v2(1, 0));
}

static void rows(const pl_joint *j, const pl_joint_pose *a, const pl_joint_pose *b, pl_rows *out)
{
    const plumb_vec2 axis = pl_joint_axis(j, a);
    out->row[0] = pl_row_along_axis(a, b, plumb_vec2_left(axis), 0);
    out->count = out->block = 1;
    out->block_most = PL_UNBOUNDED;
}

static real value(const pl_joint *j, const pl_joint_pose *a, const pl_joint_pose *b)
{
    return plumb_vec2_dot(pl_joint_apart(a, b), pl_joint_axis(j, a));
}

static pl_row slope(const pl_joint *j, const pl_joint_pose *a, const pl_joint_pose *b)
{
    return pl_row_along_axis(a, b, pl_joint_axis(j, a), 0);
}

const pl_joint_class pl_joint_rail = { .name = "rail",
                                       .has = PL_JOINT_AXIS | PL_JOINT_TRAVELS,
                                       .check = check,
                                       .rows = rows,
                                       .value = value,
                                       .slope = slope };
