// one.h - joints that are solved one by one (one.c).
#ifndef PL_JOINT_ONE_H
#define PL_JOINT_ONE_H

#include "joints/joint.h"

// A joint with its bodies. Clusters share the immovable body: each takes its own instead.
typedef struct pl_lone {
    pl_joint *joint;
    pl_solver_body *a, *b;
    pl_solver_body immovable;
} pl_lone;

// The i-th joint of all groups. `out` is not to be moved.
void pl_one_take(const pl_joint_context *c, uint32_t i, pl_lone *out);

// [1/(kg m^2)] of the body at an end (0: A), without what joints add (pl_joint_inertia).
near_real pl_one_own_inertia(const plumb_world *world, const pl_joint *j, int end);

// J v; velocities += M^-1 J^T impulse; J M^-1 K^T of two rows between the same bodies.
real pl_one_rate(const pl_row *r, const pl_solver_body *a, const pl_solver_body *b);
void pl_one_push(const pl_row *r, pl_solver_body *a, pl_solver_body *b, real impulse);
real pl_one_coupling(const pl_row *r, const pl_row *q, const pl_solver_body *a,
                     const pl_solver_body *b);
// Adds to J v of a point, whose rows have w0 and w1 of a body, what that body's turning by w does in h [s].
void pl_one_add_arc(real v[2], real w, real h, real w0, real w1);
// The same of a length: what the way across and the arcs of its ends add, C'' h / 2. 0 of other rows.
real pl_one_bow(const pl_row *r, const pl_solver_body *a, const pl_solver_body *b, real h);

// Rows, effective masses and the block's inverse, from where the bodies are.
void pl_one_rows(const plumb_world *world, pl_joint *j, const pl_solver_body *a,
                 const pl_solver_body *b);
// The same, and what J's turning owes for the impulses so far is added to what is owed; that forgotten. What a half pays of
// it: before the drift, and, with rows made anew, behind.
void pl_one_turn(const plumb_world *world, pl_joint *j, const pl_solver_body *a,
                 const pl_solver_body *b);
void pl_one_forget(pl_joint *j);
void pl_one_pay(const pl_joint_context *c, pl_joint *j, pl_solver_body *a, pl_solver_body *b);
void pl_one_refresh(const pl_joint_context *c, pl_joint *j, pl_solver_body *a, pl_solver_body *b);
// What springs go by in the next substep: how fast they are now.
void pl_one_note_springs(pl_joint *j, const pl_solver_body *a, const pl_solver_body *b);
// Behind the motion a limit that bounced wants no more than it has there: its row has turned.
void pl_one_let_go(pl_joint *j, const pl_solver_body *a, const pl_solver_body *b);

// What the impulses of a joint's block answer to an impulse of 1 along row i, so that the block stays as it is, and by how much the
// row's rate changes with both [1/kg].
real pl_one_answer(const pl_joint *j, int i, const pl_solver_body *a, const pl_solver_body *b,
                   real answer[3]);
// One row outside the block, the block; `first`: of the sweeps of a substep. Motors and springs come before the block, what must
// hold has the last word: limits behind it, with what the block answers to them (pl_one_is_answered).
void pl_one_solve_row(const pl_joint_context *c, pl_joint *j, int i, pl_solver_body *a,
                      pl_solver_body *b, pl_joint_sweep sweep, bool first);
void pl_one_solve_block(const pl_joint_context *c, pl_joint *j, pl_solver_body *a,
                        pl_solver_body *b, pl_joint_sweep sweep, bool first);
// Moves its bodies against a share of its errors (classic solver).
void pl_one_move(const pl_joint *j, pl_solver_body *a, pl_solver_body *b, real share);

// Of a rigid row that pulls. `soft` [s]: the substep that it is as stiff for (pl_soft_substep).
pl_joint_soft pl_joint_rigid(real h, real soft);
// Whether row i is a limit that a block answers to.
bool pl_one_is_answered(const pl_joint *j, int i);
// Whether row i is a motor, and the two rows before it are the limits of its value.
bool pl_one_is_limited(const pl_joint *j, int i);
// What a motor may drive at: it comes to a stop where a limit of the same value begins. Else limit and motor would push
// against one another, and the limit gives way by what the motor has.
real pl_one_drive_speed(const pl_joint *j, int i);

#endif
