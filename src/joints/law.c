// law.c - rows of joints as laws: what J v is to be, how much an impulse gives way, how large it may be.
//
// Errors are undone in the sweep that pulls, a share a substep; the one that relaxes leaves J v = 0. Springs are those of
// one.c, solved for the whole impulse: of total = - m (velocity v + error C) + (1 - impulse) total, v being that before.
//
// Reads: rows of joints. Cost: O(1).
#include "joints/law.h"

#include "plumb/math.h"
#include "world/joint_list.h"
#include "world/state.h"

// Share of an error that a substep undoes. More turns what a snapping chain leaves into a blow (DECISIONS.md).
#define RECOVERY 0.1

static void aim_at_spring(const pl_lone *l, int i, bool halves, pl_row_law *out)
{
    const pl_row *r = &l->joint->rows.row[i];
    const double k = (double)pl_one_coupling(r, r, l->a, l->b);
    const pl_joint_soft soft =
        (halves ? pl_joint_half_spring : pl_joint_spring)(r, (real)(1 / k), l->joint->h);
    const double share = plumb_max(soft.velocity, PLUMB_REAL_EPSILON);
    out->give = k * (double)soft.impulse / share;
    out->target = -(double)soft.error / share * (double)r->error +
                  (halves ? out->give * (double)l->joint->half[i].lag : 0);
}

void pl_row_law_of(const pl_lone *l, int i, pl_joint_sweep sweep, bool halves, double recovery,
                   pl_row_law *out)
{
    const pl_joint *j = l->joint;
    const pl_row *r = &j->rows.row[i];
    // The bound of a vector: of each axis by itself.
    const real bound = i < j->rows.block ? plumb_min(r->most, j->rows.block_most) : r->most;
    const double most = (double)bound * (double)j->h, back = (double)r->error / (double)j->h;
    out->in_force = r->type != PL_ROW_OFF &&
                    (halves || r->spring == PL_SPRING_NONE || sweep == PL_SWEEP_PULL) &&
                    !pl_joint_lets_come(j, i, sweep == PL_SWEEP_RELAX) &&
                    pl_one_coupling(r, r, l->a, l->b) > 0;
    out->target = out->give = 0;
    out->low = r->type == PL_ROW_LEAST ? 0 : -most;
    out->high = most;
    if (!out->in_force) {
        return;
    }
    if (r->type == PL_ROW_DRIVE) {
        out->target = (double)(halves ? pl_one_drive_speed(j, i) : r->speed);
    } else if (r->spring != PL_SPRING_NONE) {
        aim_at_spring(l, i, halves, out);
    } else if (i > 0 && i == j->struck) {
        out->target = 0; // what others hold of the blow is lost, not won (DECISIONS.md)
    } else if (r->type == PL_ROW_LEAST && r->error > 0) {
        out->target = -back; // may close the gap
    } else {
        out->target = sweep == PL_SWEEP_PULL ? -RECOVERY * back * recovery : 0;
    }
}

void pl_law_pulls(const pl_joint *j, const double impulse[PL_JOINT_ROWS], near_real pull[2])
{
    double x = 0, y = 0;
    for (int i = 0; i < j->rows.count; ++i) {
        x += (double)j->rows.row[i].bx * impulse[i];
        y += (double)j->rows.row[i].by * impulse[i];
    }
    const pl_joint_pose *a = &j->pose_a, *b = &j->pose_b;
    pull[0] = (near_real) - (x * (double)a->rx + y * (double)a->ry);
    pull[1] = (near_real)(x * (double)b->rx + y * (double)b->ry);
}
