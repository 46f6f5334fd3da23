// direct.h - joints that are solved together.
#ifndef PL_JOINT_DIRECT_H
#define PL_JOINT_DIRECT_H

#include "joints/law.h"

// A joint while it is solved: its rows in force, in the order of the unknowns.
typedef struct pl_direct_part {
    pl_lone lone;
    int count;                     // of unknowns
    uint8_t row[PL_JOINT_ROWS];    // of an unknown
    pl_row_law law[PL_JOINT_ROWS]; // of a row
    bool at_bound[PL_JOINT_ROWS];  // of a row: its impulse is at its bound, and it is no unknown
    double x[PL_JOINT_ROWS];       // of an unknown: right side, then change of impulse
    double scale[PL_JOINT_ROWS];   // of an unknown: the diagonal as assembled
    near_real inertia[2];          // [1/(kg m^2)] scratch: of its bodies before
    uint32_t where;                // scratch: the block of this column in the one that is worked on
} pl_direct_part;

// Solves the columns of the context's group. Velocities and impulses change.
void pl_direct_solve(const pl_joint_context *c, pl_joint_sweep sweep);

#endif
