// law.h - what a row of a joint asks for in a sweep, where rows are solved together.
#ifndef PL_JOINT_LAW_H
#define PL_JOINT_LAW_H

#include "joints/one.h"

// J v + give impulse = target, where the impulse is within its bounds.
typedef struct pl_row_law {
    bool in_force;
    double target;    // [m/s] or [rad/s]
    double give;      // [1/kg] of springs
    double low, high; // [N s]
} pl_row_law;

// Row i of a joint, in a sweep that pulls or relaxes; `halves`: springs give their impulses in both (spring.c); `recovery`: share of
// what errors ask for.
// Written where it stays: copying what has just been written waits for it, 8 % of a direct solution.
void pl_row_law_of(const pl_lone *lone, int i, pl_joint_sweep sweep, bool halves, double recovery,
                   pl_row_law *out);
// [N m s] impulse times arm, of A and of B, by such impulses of the rows: what pl_joint_inertia asks for.
void pl_law_pulls(const pl_joint *j, const double impulse[PL_JOINT_ROWS], near_real pull[2]);

#endif
