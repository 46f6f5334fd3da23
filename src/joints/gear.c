// gear.c - turn of A + ratio * turn of B is kept; with an axis, B's travel along it takes the place
// of its turn (rack and pinion), seen from the centre of A. Turns are those against the world.
// Value: the sum, less what it was.
#include "joints/parts.h"
#include "world/check.h"
#include "world/state.h"

static plumb_result check(const plumb_world *world, const char *fn, plumb_joint_desc *desc)
{
    desc->ratio = desc->ratio != 0 ? desc->ratio : 1;
    bool rack = desc->axis.x != 0 || desc->axis.y != 0;
    return rack ? pl_joint_check_axis(world, fn, desc, plumb_v2(0, 0))
                : pl_check_finite_vec(world, fn, "axis", desc->axis);
}

static void rows(const pl_joint *j, const pl_joint_pose *a, const pl_joint_pose *b, pl_rows *out)
{
    real ratio = j->desc.ratio;
    plumb_vec2 axis = j->desc.axis;
    pl_row row = { .aw = 1, .most = PL_UNBOUNDED, .type = PL_ROW_EQUAL };
    if (axis.x != 0 || axis.y != 0) {
        plumb_vec2 way = plumb_v2(b->x - a->x, b->y - a->y);
        real travel = plumb_vec2_dot(way, axis);
        row.bx = ratio * axis.x, row.by = ratio * axis.y;
        row.ax = -row.bx, row.ay = -row.by;
        row.error = (real)a->angle + ratio * travel - j->sum;
    } else {
        row.bw = ratio;
        row.error = (real)(a->angle + (double)ratio * b->angle) - j->sum;
    }
    out->row[0] = row;
    out->count = 1;
    out->block = 0;
}

const pl_joint_class pl_joint_gear = {
    .name = "gear",
    .has = PL_JOINT_AXIS | PL_JOINT_RATIO | PL_JOINT_CENTRAL,
    .check = check,
    .rows = rows,
    .keep = pl_value_row,
    .value = pl_value_row,
    .slope = pl_slope_row,
};
