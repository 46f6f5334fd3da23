// parts.c - values of joints; motor, spring and limits of a value. Reads: descriptor. Writes: rows.
#include "joints/parts.h"

#include "world/check.h"
#include "world/state.h"

real pl_value_turn(const pl_joint *j, const pl_joint_pose *a, const pl_joint_pose *b)
{
    (void)j;
    return (real)(b->angle - a->angle);
}

real pl_value_distance(const pl_joint *j, const pl_joint_pose *a, const pl_joint_pose *b)
{
    (void)j;
    return plumb_vec2_magnitude(pl_joint_apart(a, b));
}

pl_row pl_slope_distance(const pl_joint *j, const pl_joint_pose *a, const pl_joint_pose *b)
{
    (void)j;
    return pl_row_length(a, b, 0);
}

real pl_value_travel(const pl_joint *j, const pl_joint_pose *a, const pl_joint_pose *b)
{
    return plumb_vec2_dot(pl_joint_apart(a, b), pl_joint_axis(j, a));
}

pl_row pl_slope_travel(const pl_joint *j, const pl_joint_pose *a, const pl_joint_pose *b)
{
    return pl_row_along_axis(a, b, pl_joint_axis(j, a), 0);
}

pl_row pl_slope_row(const pl_joint *j, const pl_joint_pose *a, const pl_joint_pose *b)
{
    pl_rows made;
    pl_joint_classes[j->desc.kind]->rows(j, a, b, &made);
    return made.row[0];
}

real pl_value_row(const pl_joint *j, const pl_joint_pose *a, const pl_joint_pose *b)
{
    return pl_slope_row(j, a, b).error;
}

// [rad] of what a limit is beyond its bound it takes back so much in a step at most: turns are told apart up to three eighths of one.
#define TURNED_BACK 1

static void hold_back(const pl_joint *j, pl_row *limit)
{
    const bool turns = (pl_joint_classes[j->desc.kind]->has & PL_JOINT_RADIANS) != 0;
    if (turns && limit->error < -TURNED_BACK) {
        limit->error = -TURNED_BACK;
    }
}

void pl_rows_spring_limits(const pl_joint *j, pl_row row, pl_row *out)
{
    const plumb_joint_desc *d = &j->desc;
    out[0].type = out[1].type = out[2].type = PL_ROW_OFF;
    if (pl_joint_has_spring(d)) {
        out[0] = row;
        out[0].error -= d->rest;
        pl_row_soften(&out[0], d, j->spring_mass);
    }
    if (d->enable_limit) {
        out[1] = pl_row_at_least(row, d->lower);
        out[2] = pl_row_at_most(row, d->upper);
        hold_back(j, &out[1]);
        hold_back(j, &out[2]);
    }
}

void pl_row_motor(const pl_joint *j, pl_row row, pl_row *out)
{
    out->type = PL_ROW_OFF;
    if (j->desc.enable_motor) {
        *out = row;
        out->type = PL_ROW_DRIVE;
        out->speed = j->desc.motor_speed;
        out->most = j->desc.max_motor;
    }
}

plumb_result pl_joint_check_axis(const plumb_world *world, const char *fn, plumb_joint_desc *desc,
                                 plumb_vec2 fallback)
{
    PL_TRY(pl_check_finite_vec(world, fn, "axis", desc->axis));
    bool given = desc->axis.x != 0 || desc->axis.y != 0;
    plumb_vec2 unit = given ? plumb_vec2_unit(desc->axis) : fallback;
    if (unit.x == 0 && unit.y == 0) {
        return pl_fail(world, PLUMB_E_GEOMETRY, fn,
                       "axis is (%g, %g); it must be long enough to have a direction",
                       (double)desc->axis.x, (double)desc->axis.y);
    }
    desc->axis = unit;
    return PLUMB_OK;
}
