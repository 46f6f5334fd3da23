// distance.c - rod, rope or spring between two anchors. Rigid unless there is a limit or a spring.
// Value: the length [m].
#include "joints/parts.h"
#include "world/check.h"
#include "world/state.h"

static plumb_result check(const plumb_world *world, const char *fn, plumb_joint_desc *desc)
{
    PL_TRY(pl_check_range(world, fn, "length", desc->length, 0, PLUMB_REAL_MAX));
    PL_TRY(pl_check_range(world, fn, "lower", desc->lower, 0, PLUMB_REAL_MAX));
    if (desc->length == 0) {
        desc->length = plumb_vec2_magnitude(plumb_world_way(world, desc->anchor, desc->anchor_b));
    }
    if (desc->length == 0 && !pl_joint_has_spring(desc) && !desc->enable_limit) {
        return pl_fail(world, PLUMB_E_GEOMETRY, fn,
                       "length is 0; a rod must have length (use a revolute joint)");
    }
    return PLUMB_OK;
}

static plumb_vec2 direction(const plumb_world *world, const plumb_joint_desc *d)
{
    return plumb_vec2_unit(plumb_world_way(world, d->anchor, d->anchor_b));
}

static void rows(const pl_joint *j, const pl_joint_pose *a, const pl_joint_pose *b, pl_rows *out)
{
    pl_row length = pl_row_length(a, b, 0);
    out->row[0] = length;
    out->row[0].error -= j->desc.length;
    pl_row_soften(&out->row[0], &j->desc, j->spring_mass);
    out->row[1] = pl_row_at_least(length, j->desc.lower);
    out->row[2] = pl_row_at_most(length, j->desc.upper);
    if (!j->desc.enable_limit) {
        out->row[1].type = out->row[2].type = PL_ROW_OFF;
    } else if (!pl_joint_has_spring(&j->desc)) {
        out->row[0].type = PL_ROW_OFF;
    }
    out->count = 3;
    out->block = 0;
}

const pl_joint_class pl_joint_distance = {
    .name = "distance",
    .has = PL_JOINT_LIMIT | PL_JOINT_SPRING | PL_JOINT_TWO_ANCHORS | PL_JOINT_TRAVELS |
           PL_JOINT_LENGTH,
    .check = check,
    .direction = direction,
    .rows = rows,
    .value = pl_value_distance,
    .slope = pl_slope_distance,
};
