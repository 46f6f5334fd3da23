// strips.simd.c - loops over strips: products with the matrix, sweeps, what goes from grid to grid, steps of conjugate gradients.
//
// A strip has 16 numbers of a vector, one beside the other, so compilers make lanes of these loops. Each number is found
// alone, and sums run in 16 parts: every width gives the same bits.
//
// Reads, writes: vectors of strips. Cost: O(strips).
#include "core/wide.h"
#include "liquid/liquid.h"

#define LINE PL_LIQUID_SIDE

typedef near_real four
    __attribute__((vector_size(4 * sizeof(near_real)), aligned(sizeof(near_real)), may_alias));
#define FOUR(at) (*(four *)(void *)(at))

// Vectors reach one strip below their first and one above their last: what lies there is multiplied by 0.
WIDE_INLINE void multiply_strip(const pl_liquid_grid *g, uint32_t s, const near_real *v,
                                near_real *restrict out)
{
    const size_t at = (size_t)s * LINE;
    const size_t below = (size_t)g->strips[s].down * LINE, above = (size_t)g->strips[s].up * LINE;
    const near_real *d = g->vectors[PL_LIQUID_D] + at, *l = g->vectors[PL_LIQUID_L] + at;
    const near_real *b = g->vectors[PL_LIQUID_B] + at, *t = g->vectors[PL_LIQUID_B] + above;
    const near_real *here = v + at, *low = v + below, *high = v + above;
    for (int i = 0; i < LINE; ++i) {
        out[i] = d[i] * here[i] - l[i] * here[i - 1] - l[i + 1] * here[i + 1] - b[i] * low[i] -
                 t[i] * high[i];
    }
}

static double dot(const near_real *a, const near_real *b, uint32_t first, uint32_t end)
{
    near_real parts[LINE] = { 0 };
    for (size_t i = (size_t)first * LINE; i < (size_t)end * LINE; i += LINE) {
        for (size_t k = 0; k < LINE; ++k) {
            parts[k] += a[i + k] * b[i + k];
        }
    }
    double total = 0;
    for (int k = 0; k < LINE; ++k) {
        total += (double)parts[k];
    }
    return total;
}

static double multiply(const pl_liquid_grid *g, uint32_t first, uint32_t end, const near_real *v,
                       near_real *out)
{
    for (uint32_t s = first; s < end; ++s) {
        multiply_strip(g, s, v, out + (size_t)s * LINE);
    }
    return dot(v, out, first, end);
}

static double sweep(const pl_liquid_grid *g, uint32_t first, uint32_t end, const near_real *from,
                    near_real *to)
{
    for (uint32_t s = first; s < end; ++s) {
        const size_t at = (size_t)s * LINE;
        const near_real *r = g->vectors[PL_LIQUID_R] + at, *inverse = g->vectors[PL_LIQUID_I] + at;
        near_real product[LINE];
        multiply_strip(g, s, from, product);
        for (int i = 0; i < LINE; ++i) {
            to[at + (size_t)i] = from[at + (size_t)i] + inverse[i] * (r[i] - product[i]);
        }
    }
    return dot(to, g->vectors[PL_LIQUID_R], first, end);
}

//---- between grids -------------------------------------------------------------------------------

// What a finer strip leaves, in pairs.
WIDE_INLINE void add_pairs(const pl_liquid_grid *g, uint32_t s, near_real *restrict out)
{
    const near_real *r = g->vectors[PL_LIQUID_R] + (size_t)s * LINE;
    near_real left[LINE];
    multiply_strip(g, s, g->vectors[PL_LIQUID_Z], left);
    for (int i = 0; i < LINE; ++i) {
        left[i] = r[i] - left[i];
    }
    for (int i = 0; i < LINE; i += 8) {
        const quad a = FOUR(left + i), b = FOUR(left + i + 4);
        FOUR(out + i / 2) +=
            __builtin_shufflevector(a, b, 0, 2, 4, 6) + __builtin_shufflevector(a, b, 1, 3, 5, 7);
    }
}

static void go_down(const pl_liquid_grid *g, uint32_t first, uint32_t end)
{
    for (uint32_t s = first; s < end; ++s) {
        near_real sum[LINE] = { 0 };
        for (uint32_t k = 0; k < 4; ++k) {
            if (g->strips[s].finer[k] != 0) {
                add_pairs(g, g->strips[s].finer[k], sum + k % 2 * (LINE / 2));
            }
        }
        const size_t at = (size_t)s * LINE;
        for (uint32_t i = 0; i < LINE; ++i) {
            g->vectors[PL_LIQUID_R][at + i] = sum[i];
            g->vectors[PL_LIQUID_Z][at + i] = g->vectors[PL_LIQUID_I][at + i] * sum[i];
        }
    }
}

// Adds to four that are rows of the matrix.
WIDE_INLINE void add_where(near_real *z, const near_real *d, quad v)
{
    FOUR(z) += (quad)((FOUR(d) > 0) & (pl_near_mask)v);
}

static void come_up(const pl_liquid_grid *g, uint32_t first, uint32_t end)
{
    for (uint32_t s = first; s < end; ++s) {
        const near_real *q = g->vectors[PL_LIQUID_Q] + (size_t)s * LINE;
        for (uint32_t k = 0; k < 4; ++k) {
            const uint32_t finer = g->strips[s].finer[k];
            if (finer == 0) {
                continue;
            }
            const near_real *part = q + k % 2 * (LINE / 2);
            near_real *z = g->vectors[PL_LIQUID_Z] + (size_t)finer * LINE;
            const near_real *d = g->vectors[PL_LIQUID_D] + (size_t)finer * LINE;
            for (int i = 0; i < LINE; i += 8) {
                const quad v = FOUR(part + i / 2);
                add_where(z + i, d + i, __builtin_shufflevector(v, v, 0, 0, 1, 1));
                add_where(z + i + 4, d + i + 4, __builtin_shufflevector(v, v, 2, 2, 3, 3));
            }
        }
    }
}

//---- conjugate gradients -------------------------------------------------------------------------

static double descend(const pl_liquid_grid *g, uint32_t first, uint32_t end, near_real factor)
{
    near_real *restrict p = g->vectors[PL_LIQUID_P], *restrict r = g->vectors[PL_LIQUID_R];
    near_real *restrict z = g->vectors[PL_LIQUID_Z];
    const near_real *restrict s = g->vectors[PL_LIQUID_S], *restrict in = g->vectors[PL_LIQUID_I];
    vf most = { 0 };
    for (size_t i = (size_t)first * LINE; i < (size_t)end * LINE; i += PL_WIDTH) {
        const vf left = load(r + i) - factor * load(z + i);
        store(p + i, load(p + i) + factor * load(s + i));
        store(r + i, left);
        store(z + i, load(in + i) * left);
        most = vmax(vabs(left), most); // what is no number is not the largest
    }
    return (double)most_of(most);
}

static void turn(const pl_liquid_grid *g, uint32_t first, uint32_t end, near_real factor)
{
    near_real *restrict s = g->vectors[PL_LIQUID_S];
    const near_real *restrict q = g->vectors[PL_LIQUID_Q];
    for (size_t i = (size_t)first * LINE; i < (size_t)end * LINE; ++i) {
        s[i] = q[i] + factor * s[i];
    }
}

//---- bodies --------------------------------------------------------------------------------------

typedef double sums
    __attribute__((vector_size(4 * sizeof(double)), PL_REGISTER(PL_REGISTER_SIZE == 16 ? 16 : 32)));

WIDE_INLINE void sum_rim(const pl_liquid_grid *g, pl_liquid_body *b, const near_real *p)
{
    sums sum = { 0 };
    for (uint32_t i = b->first_rim; i < b->first_rim + b->rim_count; ++i) {
        sum += __builtin_convertvector(FOUR(g->rim_fills[i].by), sums) * (double)p[g->rim_rows[i]];
    }
    for (int k = 0; k < 3; ++k) {
        b->sum[k] = sum[k];
    }
}

static void sum_rims(pl_liquid_grid *g, const near_real *p)
{
    for (uint32_t b = 0; b < g->body_count; ++b) {
        sum_rim(g, &g->bodies[b], p);
    }
}

static double add_rims(pl_liquid_grid *g, const near_real *p, near_real *out, double push)
{
    double bend = 0;
    for (uint32_t i = 0; i < g->body_count; ++i) {
        pl_liquid_body *b = &g->bodies[i];
        sum_rim(g, b, p);
        const double motion[3] = { push * b->inv_mass_x * b->sum[0],
                                   push * b->inv_mass_y * b->sum[1],
                                   push * b->inv_inertia * b->sum[2] };
        const four moves = { (near_real)motion[0], (near_real)motion[1], (near_real)motion[2], 0 };
        bend += motion[0] * b->sum[0] + motion[1] * b->sum[1] + motion[2] * b->sum[2];
        for (uint32_t k = b->first_rim; k < b->first_rim + b->rim_count; ++k) {
            const four flow = FOUR(g->rim_fills[k].by) * moves;
            out[g->rim_rows[k]] += flow[0] + flow[1] + flow[2];
        }
    }
    return bend;
}

const pl_liquid_kernels PL_WIDE_NAME(pl_liquid_kernels) = { multiply, sweep, go_down,  come_up,
                                                            descend,  turn,  sum_rims, add_rims };
