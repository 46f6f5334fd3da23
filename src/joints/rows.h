// rows.h - what every joint is made of: scalar rows C(q) = 0 or >= 0 between two bodies, with
// Jacobian J = dC/dq, softness, bounds and accumulated impulse. A kind of joint fills rows
// (joint.h); one.c knows nothing else about it.
//
// Symbols: C position error [m] or [rad], J row over (vA, wA, vB, wB), n a unit direction from A to
// B, d the way from A's anchor to B's, r arms from centres to anchors, x cross product.
#ifndef PL_ROWS_OF_JOINTS_H
#define PL_ROWS_OF_JOINTS_H

#include "world/tables/joint.h"

#define PL_PIVOT                                                                                   \
    ((near_real)1e-6)             // [-] of the diagonal: a smaller pivot is no direction of its own
#define PL_UNBOUNDED ((real)1e30) // [N] or [N m]
// [m/s] at which a rigid point is drawn together at most: what joints that begin open gain adds up along a chain.
#define PL_CLOSES ((real)2)

static inline bool pl_row_is_spring(const pl_row *row)
{
    return row->spring != PL_SPRING_NONE && row->type == PL_ROW_EQUAL;
}

static inline bool pl_row_is_rigid(const pl_row *row)
{
    return row->spring == PL_SPRING_NONE &&
           (row->type == PL_ROW_EQUAL || (row->type == PL_ROW_LEAST && row->error < 0));
}

// d = anchor of B - anchor of A.
static inline plumb_vec2 pl_joint_apart(const pl_joint_pose *a, const pl_joint_pose *b)
{
    return (plumb_vec2){ (b->x - a->x) + (b->rx - a->rx), (b->y - a->y) + (b->ry - a->ry) };
}

// C = d . n - offset, n turning with A: J = (-n, -(ra + d) x n, n, rb x n).
pl_row pl_row_along_axis(const pl_joint_pose *a, const pl_joint_pose *b, plumb_vec2 n, real offset);
// C = angle of B - angle of A - offset.
pl_row pl_row_angle(const pl_joint_pose *a, const pl_joint_pose *b, real offset);
// C = |d| - length.
pl_row pl_row_length(const pl_joint_pose *a, const pl_joint_pose *b, real length);
// A spring, if the joint has one. `mass` [kg]: what one told by its frequency goes by; 0: what the row meets.
void pl_row_soften(pl_row *row, const plumb_joint_desc *desc, real mass);
// C >= 0 where C is that of `row` - lower, or upper - that of `row`.
pl_row pl_row_at_least(pl_row row, real lower);
pl_row pl_row_at_most(pl_row row, real upper);
// The rows d = offset, along the world's axes; offset [m] turns with A. Both bodies are pushed at one
// point, half-way between the anchors: angular momentum is kept however far apart they are, and the
// arms stay those of the joint. J is the slope of C but for half of what the anchors are apart. (With
// the exact slope, A pushed at B's anchor, a net of 100 x 100 hinges flies to pieces.)
void pl_rows_point(pl_rows *rows, const pl_joint_pose *a, const pl_joint_pose *b,
                   plumb_vec2 offset);

#endif
