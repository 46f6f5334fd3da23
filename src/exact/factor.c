// factor.c - the block factor of 1 + M^-1 J^T W J, and solutions by it.
//
// Blocks are three by three, a body each; the pattern is that of plan.c, the same above and below the diagonal, the
// numbers are not: friction that slides follows the load, not the slip. Pivots are sought within a block alone: the matrix is
// the unit matrix and what contacts add, whose symmetric part takes nothing from the diagonal.
//
// Reads: rows, nodes. Writes: blocks. Cost: 54 multiplications for each pair of entries of a column.
#include "exact/exact.h"

#include <math.h>
#include <string.h>

static double *block(double *blocks, uint32_t i)
{
    return blocks + 9 * (size_t)i;
}

//---- the matrix ------------------------------------------------------------------------------------------

// to += weight (m o p) q^T: a row pushes along p at a node of inverse masses m, as q's velocity asks for.
static void add_outer(double *to, const double *m, const double *p, const double *q, double weight)
{
    for (int i = 0; i < 3; ++i) {
        const double x = weight * m[i] * p[i];
        for (int k = 0; k < 3; ++k) {
            to[3 * i + k] += x * q[k];
        }
    }
}

// What a row that pushes along p by `weight` for each unit of q v adds.
static void add_row(const pl_exact_system *s, const pl_exact_item *item, const double *p,
                    const double *q, double weight)
{
    const uint32_t a = item->node[0], b = item->node[1];
    if (a != PL_NONE) {
        add_outer(block(s->diagonal, a), s->nodes[a].inv_mass, p, q, weight);
    }
    if (b != PL_NONE) {
        add_outer(block(s->diagonal, b), s->nodes[b].inv_mass, p + 3, q + 3, weight);
    }
    if (item->entry != PL_NONE) {
        double *of_a = block(a < b ? s->above : s->below, item->entry);
        double *of_b = block(a < b ? s->below : s->above, item->entry);
        add_outer(of_a, s->nodes[a].inv_mass, p, q + 3, weight);
        add_outer(of_b, s->nodes[b].inv_mass, p + 3, q, weight);
    }
}

static void assemble(const pl_exact_system *s)
{
    const pl_exact_island *island = s->island;
    for (uint32_t n = island->first_node; n < island->end_node; ++n) {
        memset(block(s->diagonal, n), 0, 9 * sizeof(double));
        for (int i = 0; i < 3; ++i) {
            block(s->diagonal, n)[4 * i] = 1;
        }
        memset(block(s->above, s->nodes[n].first), 0, 9 * s->nodes[n].count * sizeof(double));
        memset(block(s->below, s->nodes[n].first), 0, 9 * s->nodes[n].count * sizeof(double));
    }
    for (uint32_t k = island->first_row; k < island->end_row; ++k) {
        const pl_exact_row *r = &s->rows[k];
        if (r->weight > 0 && r->slope != 0) {
            double j[6]; // slides on a cone: along its edge
            for (int c = 0; c < 6; ++c) {
                j[c] = s->rows[r->lead].j[c] + r->slope * r->j[c];
            }
            add_row(s, r->item, j, j, r->weight);
            continue;
        }
        if (r->weight > 0) {
            add_row(s, r->item, r->j, r->j, r->weight);
        }
        for (uint32_t l = r->lead; r->slope != 0 && l < r->lead + r->leads; ++l) {
            add_row(s, r->item, r->j, s->rows[l].j, r->slope * s->rows[l].weight);
        }
    }
}

//---- the factor ------------------------------------------------------------------------------------------

// Inverse in place, by Gauss and Jordan with pivots sought by rows.
static void invert(double *d)
{
    double m[3][6];
    for (int i = 0; i < 3; ++i) {
        for (int k = 0; k < 3; ++k) {
            m[i][k] = d[3 * i + k];
            m[i][3 + k] = i == k;
        }
    }
    for (int p = 0; p < 3; ++p) {
        int best = p;
        for (int i = p + 1; i < 3; ++i) {
            best = fabs(m[i][p]) > fabs(m[best][p]) ? i : best;
        }
        const double pivot = m[best][p] != 0 ? 1 / m[best][p] : 0;
        for (int k = 0; k < 6; ++k) {
            const double x = m[best][k];
            m[best][k] = m[p][k];
            m[p][k] = x * pivot;
        }
        for (int i = 0; i < 3; ++i) {
            const double factor = i == p ? 0 : m[i][p];
            for (int k = 0; k < 6; ++k) {
                m[i][k] -= factor * m[p][k];
            }
        }
    }
    for (int i = 0; i < 3; ++i) {
        for (int k = 0; k < 3; ++k) {
            d[3 * i + k] = m[i][3 + k];
        }
    }
}

// to -= x y.
static void take_product(double *restrict to, const double *restrict x, const double *restrict y)
{
    for (int i = 0; i < 3; ++i) {
        for (int k = 0; k < 3; ++k) {
            to[3 * i + k] -= x[3 * i] * y[k] + x[3 * i + 1] * y[3 + k] + x[3 * i + 2] * y[6 + k];
        }
    }
}

// to = x d.
static void multiply(double *restrict to, const double *restrict x, const double *restrict d)
{
    for (int i = 0; i < 3; ++i) {
        for (int k = 0; k < 3; ++k) {
            to[3 * i + k] = x[3 * i] * d[k] + x[3 * i + 1] * d[3 + k] + x[3 * i + 2] * d[6 + k];
        }
    }
}

// What a node leaves of those behind it. Blocks below become shares of the node's own.
static void eliminate(const pl_exact_system *s, const pl_exact_node *node, const double *inverse)
{
    const uint32_t end = node->first + node->count;
    for (uint32_t e = node->first; e < end; ++e) {
        double x[9];
        multiply(x, block(s->below, e), inverse);
        memcpy(block(s->below, e), x, sizeof x);
    }
    for (uint32_t e = node->first; e < end; ++e) {
        const uint32_t q = s->entries[e];
        const pl_exact_node *to = &s->nodes[q];
        for (uint32_t k = to->first; k < to->first + to->count; ++k) {
            s->nodes[s->entries[k]].where = k;
        }
        take_product(block(s->diagonal, q), block(s->below, e), block(s->above, e));
        for (uint32_t f = node->first; f < end; ++f) {
            const uint32_t r = s->entries[f];
            if (r > q) {
                const uint32_t between = s->nodes[r].where;
                take_product(block(s->above, between), block(s->below, e), block(s->above, f));
                take_product(block(s->below, between), block(s->below, f), block(s->above, e));
            }
        }
    }
}

void pl_exact_factor(const pl_exact_system *s)
{
    assemble(s);
    for (uint32_t n = s->island->first_node; n < s->island->end_node; ++n) {
        invert(block(s->diagonal, n));
        eliminate(s, &s->nodes[n], block(s->diagonal, n));
    }
    ++s->exact->factored;
}

//---- solutions -------------------------------------------------------------------------------------------

// to -= x v.
static void take(double *to, const double *x, const double *v)
{
    for (int i = 0; i < 3; ++i) {
        to[i] -= x[3 * i] * v[0] + x[3 * i + 1] * v[1] + x[3 * i + 2] * v[2];
    }
}

static void apply(double v[3], const double *d)
{
    const double x[3] = { v[0], v[1], v[2] };
    for (int i = 0; i < 3; ++i) {
        v[i] = d[3 * i] * x[0] + d[3 * i + 1] * x[1] + d[3 * i + 2] * x[2];
    }
}

void pl_exact_substitute(const pl_exact_system *s, double *x)
{
    for (uint32_t n = s->island->first_node; n < s->island->end_node; ++n) {
        const pl_exact_node *node = &s->nodes[n];
        for (uint32_t e = node->first; e < node->first + node->count; ++e) {
            take(x + 3 * (size_t)s->entries[e], block(s->below, e), x + 3 * (size_t)n);
        }
    }
    for (uint32_t n = s->island->end_node; n-- > s->island->first_node;) {
        const pl_exact_node *node = &s->nodes[n];
        for (uint32_t e = node->first; e < node->first + node->count; ++e) {
            take(x + 3 * (size_t)n, block(s->above, e), x + 3 * (size_t)s->entries[e]);
        }
        apply(x + 3 * (size_t)n, block(s->diagonal, n));
    }
}
