// matrix.c - the system of a substep: symmetric, sparse, in blocks of 1 to 3 unknowns.
//
// Blocks come in the order of plan.c: the matrix of what is elastic is positive definite, a block of gas brings a negative pivot (quasi-definite: Vanderbei 1995, SIAM J. Optim. 5), so that any
// order has a factorisation. What rows of L have is found by the elimination tree (Liu 1990, SIAM J. Matrix Anal. Appl. 11); numbers
// are those of fronts.c.
//
// Reads: pairs of blocks that are neighbours. Writes: structure; the matrix as elements add to it. Cost: structure O(fill).
#include "core/sort.h"
#include "softbody/softbody.h"

#include <string.h>

//---- structure -----------------------------------------------------------------------------------

// Blocks of row k of L, in an order in which each comes before those that it changes: stack[top..blocks).
uint32_t pl_soft_reach(const pl_soft_matrix *m, uint32_t k)
{
    uint32_t top = m->blocks;
    m->mark[k] = k;
    for (uint32_t p = m->first[k]; p < m->first[k + 1]; ++p) {
        uint32_t length = 0;
        for (uint32_t i = m->column[p]; m->mark[i] != k; i = m->parent[i]) {
            m->stack[length++] = i;
            m->mark[i] = k;
        }
        while (length > 0) {
            m->stack[--top] = m->stack[--length];
        }
    }
    return top;
}

static void grow_tree(pl_soft_matrix *m)
{
    uint32_t *ancestor = m->stack;
    for (uint32_t k = 0; k < m->blocks; ++k) {
        m->parent[k] = ancestor[k] = PL_NONE;
        for (uint32_t p = m->first[k]; p < m->first[k + 1]; ++p) {
            for (uint32_t i = m->column[p]; i != PL_NONE && i < k;) {
                const uint32_t next = ancestor[i];
                ancestor[i] = k;
                if (next == PL_NONE) {
                    m->parent[i] = k;
                }
                i = next;
            }
        }
    }
}

static void count_columns(pl_soft_matrix *m)
{
    memset(m->fill, 0, m->blocks * sizeof *m->fill);
    memset(m->mark, 0xff, m->blocks * sizeof *m->mark);
    for (uint32_t k = 0; k < m->blocks; ++k) {
        for (uint32_t at = pl_soft_reach(m, k); at < m->blocks; ++at) {
            ++m->fill[m->stack[at]];
        }
    }
}

bool pl_soft_structure(pl_memory *memory, pl_soft_step *step, uint32_t blocks, uint32_t pairs,
                       int width)
{
    pl_soft_matrix *m = &step->matrix;
    const pl_keyed *keys = step->keys.data;
    const size_t words = 6 * (size_t)blocks + 8 + pairs;
    if (!pl_buffer_reserve(memory, &step->index, words * sizeof(uint32_t))) {
        return false;
    }
    uint32_t *at = step->index.data;
    m->blocks = blocks;
    m->kernels = width == 16  ? pl_soft_kernels_w16()
                 : width == 8 ? pl_soft_kernels_w8()
                              : pl_soft_kernels_w4();
    m->first = at, at += blocks + 1;
    m->parent = at, at += blocks;
    m->fill = at, at += blocks;
    m->front_of = at, at += blocks;
    m->mark = at, at += blocks;
    m->stack = at, at += blocks;
    m->column = at;
    m->entries = 0;
    uint32_t next = 0;
    for (uint32_t i = 0; i < pairs; ++i) { // keys are (higher, lower), sorted
        const uint32_t row = (uint32_t)(keys[i].key >> 32);
        if (i > 0 && keys[i].key == keys[i - 1].key) {
            continue;
        }
        while (next <= row) {
            m->first[next++] = m->entries;
        }
        m->column[m->entries++] = (uint32_t)keys[i].key;
    }
    while (next <= blocks) {
        m->first[next++] = m->entries;
    }
    grow_tree(m);
    count_columns(m);
    if (!pl_soft_make_fronts(memory, step)) {
        return false;
    }
    step->planned = true;
    return true;
}

void pl_soft_clear_right(pl_soft_matrix *m, uint32_t first, uint32_t end)
{
    memset(m->right + 3 * (size_t)first, 0, 3 * (size_t)(end - first) * sizeof(double));
}

void pl_soft_clear(pl_soft_matrix *m, uint32_t first, uint32_t end)
{
    const uint32_t entry = m->first[first], entries = m->first[end] - entry;
    memset(m->diagonal + 9 * (size_t)first, 0, 9 * (size_t)(end - first) * sizeof(double));
    memset(m->off + 9 * (size_t)entry, 0, 9 * (size_t)entries * sizeof(double));
    pl_soft_clear_right(m, first, end);
}

double *pl_soft_entry(const pl_soft_matrix *m, uint32_t row, uint32_t column)
{
    uint32_t low = m->first[row], high = m->first[row + 1];
    while (low + 1 < high) {
        const uint32_t middle = (low + high) / 2;
        if (m->column[middle] <= column) {
            low = middle;
        } else {
            high = middle;
        }
    }
    return m->off + 9 * (size_t)low;
}
