// exact.h - what the exact solver finds of a step, and room to solve it in (src/exact).
#ifndef PL_TABLE_EXACT_H
#define PL_TABLE_EXACT_H

#include "core/elimination.h"

// A body that moves: three unknowns, in the order of elimination.
typedef struct pl_exact_node {
    uint32_t slot;         // of the solver
    uint32_t first, count; // in entries of `elimination`: nodes behind it that it has to do with, or comes to
    uint32_t where;        // scratch: entry of this node in the column that is worked on
    double inv_mass[3];    // [1/kg], [1/(kg m^2)] along x, y and in turning; 0: locked
} pl_exact_node;

// A contact or a joint.
typedef struct pl_exact_item {
    uint32_t contact, joint;     // in solver.classic, in `grouped` of the joints; PL_NONE
    uint32_t turning;            // in `turnings`, of a contact that may turn within the step; PL_NONE
    uint32_t node[2];            // of A and B; PL_NONE: does not move
    uint32_t slot[2];            // of the solver
    uint32_t entry;              // between the two nodes; PL_NONE: one of them does not move
    uint32_t first_row, row_count;
} pl_exact_item;

// What is solved together: nothing of it moves anything else.
typedef struct pl_exact_island {
    uint32_t first_node, end_node, first_item, end_item, first_row, end_row;
    bool missed; // the tolerance, when last solved
    bool solved; // more or less, in some substep of the step
    bool hopeless; // a sweep that relaxes has missed it in this step
} pl_exact_island;

typedef struct pl_exact_solver {
    pl_buffer nodes;   // pl_exact_node
    pl_elimination elimination;
    pl_buffer items;   // pl_exact_item
    pl_buffer islands; // pl_exact_island
    pl_buffer rows;    // pl_exact_row
    pl_buffer swept;   // pl_exact_swept_row: of an island
    pl_buffer blocks;  // double: nine a node, then twice nine an entry, above and below the diagonal
    pl_buffer vectors; // double, of nodes
    pl_buffer turnings; // pl_exact_turning: of contacts that may turn within the step
    pl_buffer scratch;
    uint32_t node_count, entry_count, item_count, island_count, row_count, turning_count;
    // Of the step: factorisations; islands that missed the tolerance in some substep; largest residual [-] of them all,
    // relative to the speeds that the rows had to undo.
    uint32_t factored, missed;
    double residual;
    bool told; // in the log
} pl_exact_solver;

#endif
