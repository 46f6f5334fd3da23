// matrix.c - the system of a substep: symmetric, sparse, in blocks of 1 to 3 unknowns, factored as L D L^T without pivoting.
//
// Blocks come in the order of plan.c: the matrix of what is elastic is positive definite, a block of gas brings a negative pivot (quasi-definite: Vanderbei 1995, SIAM J. Optim. 5), so that any
// order has a factorisation. Rows of L are found by the elimination tree (Liu 1990, SIAM J. Matrix Anal. Appl. 11) and
// solved one after the other (up-looking: Davis 2006, Direct Methods for Sparse Linear Systems, ch. 4).
//
// Reads: pairs of blocks that are neighbours. Writes: structure, factors. Cost: structure O(fill), factors O(sum of squares of
// what columns have). Sums run in a fixed order.
#include "core/sort.h"
#include "softbody/softbody.h"

#include <string.h>

//---- structure -----------------------------------------------------------------------------------

// Blocks of row k of L, in an order in which each comes before those that it changes: stack[top..blocks).
static uint32_t reach(const pl_soft_matrix *m, uint32_t k)
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
        for (uint32_t at = reach(m, k); at < m->blocks; ++at) {
            ++m->fill[m->stack[at]];
        }
    }
    m->start[0] = 0;
    for (uint32_t k = 0; k < m->blocks; ++k) {
        m->start[k + 1] = m->start[k] + m->fill[k];
    }
    m->factors = m->start[m->blocks];
}

bool pl_soft_structure(pl_memory *memory, pl_soft_step *step, uint32_t blocks, uint32_t pairs,
                       int width)
{
    pl_soft_matrix *m = &step->matrix;
    const pl_keyed *keys = step->keys.data;
    const size_t words = 7 * (size_t)blocks + 8 + pairs;
    if (!pl_buffer_reserve(memory, &step->index, words * sizeof(uint32_t))) {
        return false;
    }
    uint32_t *at = step->index.data;
    m->blocks = blocks;
    m->kernel = width == 16  ? pl_soft_squares_w16
                : width == 8 ? pl_soft_squares_w8
                             : pl_soft_squares_w4;
    m->size = step->shapes.data;
    m->first = at, at += blocks + 1;
    m->start = at, at += blocks + 1;
    m->parent = at, at += blocks;
    m->fill = at, at += blocks;
    m->mark = at, at += blocks;
    m->stack = at, at += blocks;
    m->squares = (uint8_t *)at, at += blocks;
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
    const size_t numbers = 9 * (4 * (size_t)blocks + m->entries + m->factors) + 18 * (size_t)blocks;
    const size_t bytes = numbers * sizeof(double) + m->factors * sizeof(uint32_t);
    if (!pl_buffer_reserve(memory, &step->numbers, bytes)) {
        return false;
    }
    double *d = step->numbers.data;
    m->diagonal = d, d += 9 * (size_t)blocks;
    m->off = d, d += 9 * (size_t)m->entries;
    m->pivot = d, d += 9 * (size_t)blocks;
    m->split = d, d += 9 * (size_t)blocks;
    m->work = d, d += 9 * (size_t)blocks;
    m->l = d, d += 9 * (size_t)m->factors;
    m->right = d, d += 3 * (size_t)blocks;
    m->u = d, d += 3 * (size_t)blocks;
    m->tried = d, d += 3 * (size_t)blocks;
    m->slope = d, d += 3 * (size_t)blocks;
    m->way = d, d += 3 * (size_t)blocks;
    m->sheets = d, d += 3 * (size_t)blocks;
    m->row_of = (uint32_t *)(void *)d;
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

//---- numbers: blocks of the matrix are by rows, 3 numbers a row; those of L as many as they have columns ----

// A pivot as L D L^T, number by number: below its diagonal what L has, on it 1 / D. An inverse by determinants is off by the square
// of how much stiffer one way is than another, and what pulls two apart was not the same for both (DECISIONS.md).
static void split(const double *a, int n, double *out)
{
    out[0] = 1 / a[0];
    if (n == 1) {
        return;
    }
    out[3] = a[n] * out[0];
    out[4] = 1 / (a[n + 1] - out[3] * a[n]);
    if (n == 2) {
        return;
    }
    const double between = a[7] - out[3] * a[6];
    out[6] = a[6] * out[0];
    out[7] = between * out[4];
    out[8] = 1 / (a[8] - out[6] * a[6] - out[7] * between);
}

// x becomes pivot^-1 x.
static void divide(const double *f, int n, double *x)
{
    if (n == 1) {
        x[0] *= f[0];
        return;
    }
    x[1] -= f[3] * x[0];
    if (n == 2) {
        x[1] *= f[4];
        x[0] = x[0] * f[0] - f[3] * x[1];
        return;
    }
    x[2] = (x[2] - f[6] * x[0] - f[7] * x[1]) * f[8];
    x[1] = x[1] * f[4] - f[7] * x[2];
    x[0] = x[0] * f[0] - f[3] * x[1] - f[6] * x[2];
}

// to -= a b^T: rows x between, columns x between.
static void take_product(double *to, const double *a, const double *b, int rows, int columns,
                         int between)
{
    for (int i = 0; i < rows; ++i) {
        for (int j = 0; j < columns; ++j) {
            double sum = 0;
            for (int k = 0; k < between; ++k) {
                sum += a[between * i + k] * b[between * j + k];
            }
            to[columns * i + j] -= sum;
        }
    }
}

static void pack(double *to, const double *from, int rows, int columns)
{
    for (int i = 0; i < rows; ++i) {
        for (int j = 0; j < columns; ++j) {
            to[columns * i + j] = from[3 * i + j];
        }
    }
}

// What the rest of a row loses by the block y of column i.
static void take_column(const pl_soft_matrix *m, uint32_t i, int n, const double *y,
                        const double *column)
{
    for (uint32_t p = 0; p < m->fill[i]; ++p) {
        const uint32_t j = m->row_of[m->start[i] + p];
        take_product(m->work + 9 * (size_t)j, y, column + 9 * (size_t)p, n, m->size[j], m->size[i]);
    }
}

// y becomes a block of L; the pivot of its row loses y L^T.
static void close_block(const double *f, int columns, int n, const double *y, double *l,
                        double *pivot)
{
    memcpy(l, y, (size_t)(n * columns) * sizeof(double));
    for (int r = 0; r < n; ++r) {
        divide(f, columns, l + columns * r);
    }
    take_product(pivot, l, y, n, n, columns);
}

// The same of two by two.
static inline void close_square(const double *f, const double *y, double *l, double *pivot)
{
    for (int r = 0; r < 4; r += 2) {
        const double second = (y[r + 1] - f[3] * y[r]) * f[4];
        l[r] = y[r] * f[0] - f[3] * second;
        l[r + 1] = second;
    }
    pivot[0] -= l[0] * y[0] + l[1] * y[1];
    pivot[1] -= l[0] * y[2] + l[1] * y[3];
    pivot[2] -= l[2] * y[0] + l[3] * y[1];
    pivot[3] -= l[2] * y[2] + l[3] * y[3];
}

// Row k: what A has of it becomes L D of it block by block, and L.
static void factor_row(pl_soft_matrix *m, uint32_t k)
{
    const int n = m->size[k];
    const uint32_t top = reach(m, k);
    double *pivot = m->pivot + 9 * (size_t)k;
    for (uint32_t at = top; at < m->blocks; ++at) {
        memset(m->work + 9 * (size_t)m->stack[at], 0, 9 * sizeof(double));
    }
    for (uint32_t p = m->first[k]; p < m->first[k + 1]; ++p) {
        pack(m->work + 9 * (size_t)m->column[p], m->off + 9 * (size_t)p, n, m->size[m->column[p]]);
    }
    pack(pivot, m->diagonal + 9 * (size_t)k, n, n);
    for (uint32_t at = top; at < m->blocks; ++at) {
        const uint32_t i = m->stack[at], start = m->start[i], fill = m->fill[i];
        const double *y = m->work + 9 * (size_t)i;
        double *column = m->l + 9 * (size_t)start, *l = column + 9 * (size_t)fill;
        if (n == 2 && m->squares[i]) {
            m->kernel(m->work, y, column, m->row_of + start, fill);
            close_square(m->split + 9 * (size_t)i, y, l, pivot);
        } else {
            take_column(m, i, n, y, column);
            close_block(m->split + 9 * (size_t)i, m->size[i], n, y, l, pivot);
        }
        m->row_of[start + fill] = k;
        ++m->fill[i];
        m->squares[i] = m->squares[i] && n == 2;
    }
    split(pivot, n, m->split + 9 * (size_t)k);
}

void pl_soft_factor(pl_soft_matrix *m, uint32_t first, uint32_t end)
{
    memset(m->fill + first, 0, (end - first) * sizeof *m->fill);
    memset(m->mark + first, 0xff, (end - first) * sizeof *m->mark);
    for (uint32_t k = first; k < end; ++k) {
        m->squares[k] = m->size[k] == 2;
    }
    for (uint32_t k = first; k < end; ++k) {
        factor_row(m, k);
    }
}

// x of the rows of a column lose L x of it; its own x loses what these make of L^T.
static void push_column(const pl_soft_matrix *m, uint32_t i, double *x)
{
    const double *from = x + 3 * (size_t)i;
    const int columns = m->size[i];
    for (uint32_t p = m->start[i]; p < m->start[i + 1]; ++p) {
        const double *l = m->l + 9 * (size_t)p;
        double *to = x + 3 * (size_t)m->row_of[p];
        for (int r = 0; r < m->size[m->row_of[p]]; ++r) {
            for (int c = 0; c < columns; ++c) {
                to[r] -= l[columns * r + c] * from[c];
            }
        }
    }
}

static void pull_column(const pl_soft_matrix *m, uint32_t i, const double *x, double *sum)
{
    const int columns = m->size[i];
    for (uint32_t p = m->start[i]; p < m->start[i + 1]; ++p) {
        const double *l = m->l + 9 * (size_t)p, *from = x + 3 * (size_t)m->row_of[p];
        for (int r = 0; r < m->size[m->row_of[p]]; ++r) {
            for (int c = 0; c < columns; ++c) {
                sum[c] -= l[columns * r + c] * from[r];
            }
        }
    }
}

static void push_squares(const pl_soft_matrix *m, uint32_t i, double *x)
{
    const double a = x[3 * (size_t)i], b = x[3 * (size_t)i + 1];
    for (uint32_t p = m->start[i]; p < m->start[i + 1]; ++p) {
        const double *l = m->l + 9 * (size_t)p;
        double *to = x + 3 * (size_t)m->row_of[p];
        to[0] = to[0] - l[0] * a - l[1] * b;
        to[1] = to[1] - l[2] * a - l[3] * b;
    }
}

static void pull_squares(const pl_soft_matrix *m, uint32_t i, const double *x, double *sum)
{
    double a = sum[0], b = sum[1];
    for (uint32_t p = m->start[i]; p < m->start[i + 1]; ++p) {
        const double *l = m->l + 9 * (size_t)p, *from = x + 3 * (size_t)m->row_of[p];
        a = a - l[0] * from[0] - l[2] * from[1];
        b = b - l[1] * from[0] - l[3] * from[1];
    }
    sum[0] = a, sum[1] = b;
}

void pl_soft_solve(const pl_soft_matrix *m, uint32_t first, uint32_t end)
{
    double *x = m->right;
    for (uint32_t i = first; i < end; ++i) {
        (m->squares[i] ? push_squares : push_column)(m, i, x);
    }
    for (uint32_t i = end; i-- > first;) {
        double *to = x + 3 * (size_t)i, sum[3] = { to[0], to[1], to[2] };
        divide(m->split + 9 * (size_t)i, m->size[i], sum);
        (m->squares[i] ? pull_squares : pull_column)(m, i, x, sum);
        memcpy(to, sum, (size_t)m->size[i] * sizeof(double));
    }
}
