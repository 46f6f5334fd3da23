// graph.h - a formula while it is compiled: nodes that share what they have in common.
#ifndef PL_FORMULA_GRAPH_H
#define PL_FORMULA_GRAPH_H

#include "formula/ops.h"

enum {
    PL_NODES = 640,
    PL_NODE_LISTS = 256,     // of nodes that may be alike
    PL_NO_NODE = UINT16_MAX, // of a slope: 0 everywhere
    PL_GRAPH_NUMBERS = PL_FORMULA_CONSTANTS
};

// What it takes stands before it.
typedef struct pl_node {
    uint8_t op;
    uint8_t is_even;  // the same at all places
    uint16_t a, b, c; // nodes; of a number a is which
    uint16_t next;    // in its list
} pl_node;

typedef struct pl_graph {
    pl_node nodes[PL_NODES];
    double numbers[PL_GRAPH_NUMBERS];
    uint16_t lists[PL_NODE_LISTS];
    uint16_t count, number_count;
    bool is_full; // it has not taken all
} pl_graph;

// Where a part of the text was found to be none.
typedef struct pl_parse {
    const char *text;
    int at, depth;
    bool is_potential, failed;
    pl_graph *graph;
    pl_formula_fault *fault;
} pl_parse;

//---- graph.c -------------------------------------------------------------------------------------

void pl_graph_clear(pl_graph *g);
// The node that is so; numbers are worked out. PL_NO_NODE never.
uint16_t pl_graph_number(pl_graph *g, double value);
uint16_t pl_graph_leaf(pl_graph *g, pl_formula_op op);
uint16_t pl_graph_node(pl_graph *g, pl_formula_op op, uint16_t a, uint16_t b, uint16_t c);
// u^v: products and roots where v is a small number.
uint16_t pl_graph_power(pl_graph *g, uint16_t u, uint16_t v);
// How a node changes with a variable; PL_NO_NODE: not at all.
uint16_t pl_graph_slope(pl_graph *g, uint16_t node, pl_formula_op variable);

static inline bool pl_graph_is_number(const pl_graph *g, uint16_t node)
{
    return g->nodes[node].op == PL_OP_NUMBER;
}

static inline double pl_graph_value(const pl_graph *g, uint16_t node)
{
    return g->numbers[g->nodes[node].a];
}

//---- parse.c -------------------------------------------------------------------------------------

// The node of a text; false: see the fault.
bool pl_formula_parse(pl_graph *g, const char *text, bool is_potential, pl_formula_fault *fault,
                      uint16_t *node);

//---- number.c ------------------------------------------------------------------------------------

// Reads a decimal number without a sign, "1", ".5", "2.5e-3", as the nearest double; returns how many characters it has, 0 where
// there is none. Infinite where it is too large.
int pl_formula_number(const char *text, double *value);

#endif
