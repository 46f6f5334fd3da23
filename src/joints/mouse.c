// mouse.c - a spring of bounded force draws a point of B to a target, which is A's anchor. Value:
// how far it is from there [m].
#include "joints/parts.h"

#define HERTZ   ((real)5) // quick to follow, slow enough to be seen swinging
#define DAMPING ((real)1) // critical

static plumb_result check(const plumb_world *world, const char *fn, plumb_joint_desc *desc)
{
    (void)world;
    (void)fn;
    if (!pl_spring_is_in_newtons(desc)) {
        desc->hertz = desc->hertz > 0 ? desc->hertz : HERTZ;
        desc->damping = desc->damping > 0 ? desc->damping : DAMPING;
    }
    return PLUMB_OK;
}

static void rows(const pl_joint *j, const pl_joint_pose *a, const pl_joint_pose *b, pl_rows *out)
{
    pl_rows_point(out, a, b, plumb_v2(0, 0));
    for (int i = 0; i < 2; ++i) {
        pl_row_soften(&out->row[i], &j->desc, 0);
    }
    out->block_most = pl_joint_bound(j->desc.max_force);
    out->count = 2;
}

const pl_joint_class pl_joint_mouse = { .name = "mouse",
                                        .has = PL_JOINT_SPRING | PL_JOINT_TARGET |
                                               PL_JOINT_TRAVELS | PL_JOINT_FORCE,
                                        .check = check,
                                        .rows = rows,
                                        .value = pl_value_distance,
                                        .slope = pl_slope_distance };
