// rows.c - the rows that joints are put together from. Derivations: d/dt of C with the velocity of
// a body's point v + w x r; tests/unit/test_joints.c compares every J with finite differences of C.
//
// Reads: two poses. Writes: rows. Cost: O(1).
#include "joints/rows.h"

#include "plumb/math.h"

#define TAU ((real)6.2831853071795864769)

// A row that pushes A at arm_a, B at arm_b. Member by member: a row that is put together and then copied is
// read back in larger parts than it was written in, and waits for that.
static void put_along(pl_row *row, plumb_vec2 arm_a, plumb_vec2 arm_b, plumb_vec2 n, real error,
                      pl_row_form form)
{
    row->ax = -n.x, row->ay = -n.y;
    row->aw = -plumb_vec2_cross(arm_a, n);
    row->bx = n.x, row->by = n.y;
    row->bw = plumb_vec2_cross(arm_b, n);
    row->error = error;
    row->speed = 0;
    row->along_a = row->along_b = row->over = 0;
    row->most = PL_UNBOUNDED;
    row->type = PL_ROW_EQUAL;
    row->form = form;
    row->spring = PL_SPRING_NONE;
}

pl_row pl_row_along_axis(const pl_joint_pose *a, const pl_joint_pose *b, plumb_vec2 n, real offset)
{
    pl_row row;
    plumb_vec2 d = pl_joint_apart(a, b);
    put_along(&row, plumb_v2(a->rx + d.x, a->ry + d.y), plumb_v2(b->rx, b->ry), n,
              plumb_vec2_dot(d, n) - offset, PL_FORM_ALONG);
    return row;
}

pl_row pl_row_angle(const pl_joint_pose *a, const pl_joint_pose *b, real offset)
{
    return (pl_row){ .aw = -1,
                     .bw = 1,
                     .error = (real)(b->angle - a->angle - (double)offset),
                     .most = PL_UNBOUNDED,
                     .type = PL_ROW_EQUAL,
                     .form = PL_FORM_ANGLE };
}

// Without length there is no direction: any will do, the row pushes the points apart along it.
pl_row pl_row_length(const pl_joint_pose *a, const pl_joint_pose *b, real length)
{
    pl_row row;
    real now;
    plumb_vec2 n = plumb_vec2_unit_and_magnitude(pl_joint_apart(a, b), &now);
    n = now > 0 ? n : plumb_v2(1, 0);
    const plumb_vec2 arm_a = plumb_v2(a->rx, a->ry), arm_b = plumb_v2(b->rx, b->ry);
    put_along(&row, arm_a, arm_b, n, now - length, PL_FORM_LENGTH);
    row.along_a = plumb_vec2_dot(n, arm_a), row.along_b = plumb_vec2_dot(n, arm_b);
    row.over = now > 0 ? 1 / now : 0;
    return row;
}

void pl_row_soften(pl_row *row, const plumb_joint_desc *desc, real mass)
{
    if (pl_spring_is_in_newtons(desc)) {
        row->spring = PL_SPRING_NEWTONS;
        row->stiff = desc->stiffness, row->damp = desc->damper;
    } else if (desc->hertz > 0 && mass > 0) {
        const real w = TAU * desc->hertz;
        row->spring = PL_SPRING_NEWTONS;
        row->stiff = mass * w * w, row->damp = 2 * desc->damping * mass * w;
    } else {
        row->spring = desc->hertz > 0 ? PL_SPRING_HERTZ : PL_SPRING_NONE;
        row->stiff = desc->hertz, row->damp = desc->damping;
    }
}

pl_row pl_row_at_least(pl_row row, real lower)
{
    row.error -= lower;
    row.type = PL_ROW_LEAST;
    return row;
}

pl_row pl_row_at_most(pl_row row, real upper)
{
    return (pl_row){ .ax = -row.ax,
                     .ay = -row.ay,
                     .aw = -row.aw,
                     .bx = -row.bx,
                     .by = -row.by,
                     .bw = -row.bw,
                     .error = upper - row.error,
                     .along_a = -row.along_a,
                     .along_b = -row.along_b,
                     .over = -row.over,
                     .most = row.most,
                     .type = PL_ROW_LEAST,
                     .form = row.form };
}

void pl_rows_point(pl_rows *rows, const pl_joint_pose *a, const pl_joint_pose *b, plumb_vec2 offset)
{
    plumb_vec2 held = plumb_rot_apply((plumb_rot){ a->c, a->s }, offset);
    plumb_vec2 error = plumb_vec2_sub(pl_joint_apart(a, b), held);
    plumb_vec2 half = plumb_v2(error.x / 2, error.y / 2);
    plumb_vec2 arm_a = plumb_v2(a->rx + held.x + half.x, a->ry + held.y + half.y);
    plumb_vec2 arm_b = plumb_v2(b->rx - half.x, b->ry - half.y);
    put_along(&rows->row[0], arm_a, arm_b, plumb_v2(1, 0), error.x, PL_FORM_POINT_X);
    put_along(&rows->row[1], arm_a, arm_b, plumb_v2(0, 1), error.y, PL_FORM_POINT_Y);
    rows->block = 2;
    rows->block_most = PL_UNBOUNDED;
}
