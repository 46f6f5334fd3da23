// rows.h - what every joint is made of: scalar rows C(q) = 0 or >= 0 between two bodies, with
// Jacobian J = dC/dq, softness, bounds and accumulated impulse. A kind of joint fills rows
// (joint.h); solve.c knows nothing else about it.
//
// Symbols: C position error [m] or [rad], J row over (vA, wA, vB, wB), n a unit direction from A to
// B, d the way from A's anchor to B's, r arms from centres to anchors, x cross product.
#ifndef PL_ROWS_OF_JOINTS_H
#define PL_ROWS_OF_JOINTS_H

#include "plumb/types.h"
#include "world/columns.h"

#define PL_JOINT_ROWS 6
#define PL_PIVOT                                                                                   \
    ((near_real)1e-6)             // [-] of the diagonal: a smaller pivot is no direction of its own
#define PL_UNBOUNDED ((real)1e30) // [N] or [N m]

// Where a body is, as rows see it.
typedef struct pl_joint_pose {
    real x, y;    // [m] centre, from A's centre at the start of the step
    double angle; // [rad] turned since the joint was made, full turns included
    real c, s;    // rotation
    real rx, ry;  // [m] centre to anchor, in world axes
} pl_joint_pose;

typedef enum pl_row_type {
    PL_ROW_OFF,   // not in force
    PL_ROW_EQUAL, // C = 0; with hertz > 0 a spring
    PL_ROW_LEAST, // C >= 0
    PL_ROW_DRIVE  // J v = speed; C is the coordinate driven
} pl_row_type;

// How a row follows from where the bodies are: what the wide kernels (joint.simd.c) go by.
typedef enum pl_row_form {
    PL_FORM_OWN,     // only its kind knows
    PL_FORM_POINT_X, // pl_rows_point, always both
    PL_FORM_POINT_Y,
    PL_FORM_ALONG, // pl_row_along_axis, the axis turning with A
    PL_FORM_ANGLE, // pl_row_angle
    PL_FORM_LENGTH // pl_row_length
} pl_row_form;

typedef struct pl_row {
    real ax, ay, aw, bx, by, bw; // J
    real error;                  // C
    real speed;                  // [m/s] or [rad/s] of DRIVE
    real hertz, damping;         // of the spring
    real most;                   // [N] or [N m] largest force either way
    pl_row_type type;
    pl_row_form form;
} pl_row;

typedef struct pl_rows {
    int count;       // rows; the same for all life of a joint
    int block;       // so many of the first are solved as one system; 0: none. All are of one type
    real block_most; // [N] bound of the block's force as a vector (two rows)
    pl_row row[PL_JOINT_ROWS];
} pl_rows;

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
