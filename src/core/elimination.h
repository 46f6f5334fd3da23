// elimination.h - the order in which the unknowns of a sparse symmetric matrix are eliminated, and what that fills in.
//
// Vertices are unknowns, or blocks of them; pairs are those that have to do with one another. The order is that of least
// degree, by the quotient graph: a vertex that is gone leaves an element, the list of those behind it that it made neighbours (George
// and Liu 1989). Chains and trees fill in nothing, and who has many neighbours comes late. Components come one after another,
// and the order of one does not depend on the others. Of what is large and flat that order is a poor one: cut in parts first (`whole`), a
// cloth of 1,000 takes two thirds of the products, of 10,000 a half.
#ifndef PL_ELIMINATION_H
#define PL_ELIMINATION_H

#include "core/memory.h"

typedef struct pl_elimination {
    pl_buffer words, entries, cuts;
    // Given.
    uint32_t count, pair_count;
    uint32_t
        whole; // components of more vertices are cut first (core/dissection.h); pl_elimination_open: none
    uint32_t *pairs; // two vertices each; the same pair may come twice
    // Told of each vertex.
    uint32_t *rank;      // its place in the order
    uint32_t *component; // components are numbered by their lowest vertex
    // Told of each place.
    uint32_t *order; // the vertex
    uint32_t *column,
        *fill; // in `entries`: the first of the vertices that its elimination fills in, how many
    // Told of each component: its first place; behind the last one the count.
    uint32_t *start;
    uint32_t component_count, entry_count;
    // Scratch.
    uint32_t *first, *length, *near; // neighbours of a vertex
    uint32_t *elements; // how many of its list are elements, told by their place; these come first
    uint32_t *mark, *seen;            // stamp of the column, and of the count, that met it last
    uint32_t *degree, *next, *before; // in the list of its degree
    uint32_t *list;                   // a degree: first vertex
    uint8_t *used;                    // of a place: it is an element no more
    uint32_t stamp, seen_stamp;
} pl_elimination;

// Room for so many vertices, and pairs at most; then `pairs` may be filled and counted. False when out of memory.
bool pl_elimination_open(pl_memory *memory, pl_elimination *e, uint32_t vertices, uint32_t pairs);
// Finds components, order and fill. A component of more than `most` entries is dense: its vertices come in the order in which they
// hang together, without entries. False when out of memory. Cost: O(entries), and what degrees take to be counted.
bool pl_elimination_run(pl_memory *memory, pl_elimination *e, uint32_t most);
void pl_elimination_free(pl_memory *memory, pl_elimination *e);

#endif
