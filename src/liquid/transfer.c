// transfer.c - velocities from particles to faces and back: affine particle in cell (Jiang et al. 2015).
//
// A particle carries its velocity and how that changes around it, so angular momentum survives the way to the grid
// and back. Faces gather from the sorted points of six cells each; nothing is scattered, so any thread may
// take any cell. Weights are bilinear.
//
// Reads, writes: faces, points. Cost: O(cells + 12 points).
#include "liquid/liquid.h"

typedef struct sum {
    near_real weight, value;
} sum;

// Of the points of a cell for a face at (x, y) from the cell's corner: the x component, or y.
static void gather_u(const pl_liquid_grid *g, uint32_t c, near_real x, near_real y, sum *s)
{
    for (uint32_t k = g->first[c]; k < g->first[c + 1]; ++k) {
        const pl_liquid_point *p = &g->points[k];
        const near_real dx = x - p->fx, dy = y - p->fy;
        const near_real wx = 1 - (dx < 0 ? -dx : dx), wy = 1 - (dy < 0 ? -dy : dy);
        const near_real w = wy > 0 ? wx * wy : 0;
        s->weight += w;
        s->value += w * (p->u + p->ux * dx + p->uy * dy);
    }
}

static void gather_v(const pl_liquid_grid *g, uint32_t c, near_real x, near_real y, sum *s)
{
    for (uint32_t k = g->first[c]; k < g->first[c + 1]; ++k) {
        const pl_liquid_point *p = &g->points[k];
        const near_real dx = x - p->fx, dy = y - p->fy;
        const near_real wx = 1 - (dx < 0 ? -dx : dx), wy = 1 - (dy < 0 ? -dy : dy);
        const near_real w = wx > 0 ? wx * wy : 0;
        s->weight += w;
        s->value += w * (p->v + p->vx * dx + p->vy * dy);
    }
}

#define LEAST_WEIGHT ((near_real)1e-4)
#define HALF         ((near_real)0.5)

void pl_liquid_to_grid(pl_liquid_grid *g)
{
    for (uint32_t c = 1; c < g->cell_count; ++c) {
        const uint32_t left = g->left[c], right = g->right[c], down = g->down[c], up = g->up[c];
        sum u = { 0, 0 }, v = { 0, 0 };
        gather_u(g, g->left[down], 1, 1 + HALF, &u);
        gather_u(g, down, 0, 1 + HALF, &u);
        gather_u(g, left, 1, HALF, &u);
        gather_u(g, c, 0, HALF, &u);
        gather_u(g, g->left[up], 1, -HALF, &u);
        gather_u(g, up, 0, -HALF, &u);
        gather_v(g, g->left[down], 1 + HALF, 1, &v);
        gather_v(g, down, HALF, 1, &v);
        gather_v(g, g->right[down], -HALF, 1, &v);
        gather_v(g, left, 1 + HALF, 0, &v);
        gather_v(g, c, HALF, 0, &v);
        gather_v(g, right, -HALF, 0, &v);
        g->known_u[c] = u.weight > LEAST_WEIGHT;
        g->known_v[c] = v.weight > LEAST_WEIGHT;
        g->u[c] = g->known_u[c] ? u.value / u.weight : 0;
        g->v[c] = g->known_v[c] ? v.value / v.weight : 0;
    }
}

//---- where nothing is known ----------------------------------------------------------------------

// The mean of the known faces beside it. What becomes known in this sweep is marked 2: order decides nothing.
static void spread(const pl_liquid_grid *g, near_real *value, uint8_t *known, uint32_t c)
{
    const uint32_t near[4] = { g->left[c], g->right[c], g->down[c], g->up[c] };
    near_real total = 0;
    int count = 0;
    for (int k = 0; k < 4; ++k) {
        if (known[near[k]] == 1) {
            total += value[near[k]];
            ++count;
        }
    }
    if (count > 0) {
        value[c] = total / (near_real)count;
        known[c] = 2;
    }
}

void pl_liquid_extrapolate(pl_liquid_grid *g, near_real *u, near_real *v, int cells)
{
    for (int sweep = 0; sweep < cells; ++sweep) {
        for (uint32_t c = 1; c < g->cell_count; ++c) {
            if (g->known_u[c] == 0) {
                spread(g, u, g->known_u, c);
            }
            if (g->known_v[c] == 0) {
                spread(g, v, g->known_v, c);
            }
        }
        for (uint32_t c = 1; c < g->cell_count; ++c) {
            g->known_u[c] = g->known_u[c] != 0;
            g->known_v[c] = g->known_v[c] != 0;
        }
    }
}

void pl_liquid_accelerate(pl_liquid_grid *g, near_real du, near_real dv)
{
    for (uint32_t c = 1; c < g->cell_count; ++c) {
        g->u[c] += du;
        g->v[c] += dv;
    }
}

//---- back ----------------------------------------------------------------------------------------

typedef struct square {
    near_real value, x, y; // with its slopes
} square;

// Between the faces at a, at its right, above both.
static square between(const pl_liquid_grid *g, const near_real *f, uint32_t a, near_real x,
                      near_real y)
{
    const uint32_t b = g->up[a];
    const near_real f00 = f[a], f10 = f[g->right[a]], f01 = f[b], f11 = f[g->right[b]];
    const near_real low = f00 + x * (f10 - f00), high = f01 + x * (f11 - f01);
    return (square){ low + y * (high - low), (1 - y) * (f10 - f00) + y * (f11 - f01), high - low };
}

static square u_at(const pl_liquid_grid *g, const near_real *u, const pl_liquid_point *p)
{
    return p->fy < HALF ? between(g, u, g->down[p->cell], p->fx, p->fy + HALF)
                        : between(g, u, p->cell, p->fx, p->fy - HALF);
}

static square v_at(const pl_liquid_grid *g, const near_real *v, const pl_liquid_point *p)
{
    return p->fx < HALF ? between(g, v, g->left[p->cell], p->fx + HALF, p->fy)
                        : between(g, v, p->cell, p->fx - HALF, p->fy);
}

void pl_liquid_from_grid(pl_liquid_grid *g)
{
    for (uint32_t k = 0; k < g->point_count; ++k) {
        pl_liquid_point *p = &g->points[k];
        const square u = u_at(g, g->u, p), v = v_at(g, g->v, p);
        p->u = u.value, p->ux = u.x, p->uy = u.y;
        p->v = v.value, p->vx = v.x, p->vy = v.y;
    }
}

void pl_liquid_sample(const pl_liquid_grid *g, const near_real *u, const near_real *v,
                      const pl_liquid_point *p, near_real *x, near_real *y)
{
    *x = u_at(g, u, p).value;
    *y = v_at(g, v, p).value;
}

//---- viscosity -----------------------------------------------------------------------------------

#define MOST_SWEEPS  100
#define MOST_A_SWEEP 0.125 // [-] 1/4 is just stable, and less beside walls

typedef struct component {
    const near_real *value, *open, *solid;
    const uint8_t *known;
    near_real *to;
    int along; // the first neighbour along the face: walls there are half a cell away, and cling
} component;

static near_real slope_to(const component *q, uint32_t c, uint32_t near, int side)
{
    if (q->open[near] == 0) {
        const near_real beside = side / 2 == q->along / 2 ? 2 : 1;
        return beside * (q->solid[near] - q->value[c]);
    }
    return q->known[near] ? q->value[near] - q->value[c] : 0;
}

static void sweep(const pl_liquid_grid *g, const component *q, near_real k)
{
    for (uint32_t c = 1; c < g->cell_count; ++c) {
        const near_real value = q->value[c];
        const bool acts = q->known[c] && q->open[c] > 0;
        q->to[c] = value;
        if (acts) {
            q->to[c] += k * (slope_to(q, c, g->left[c], 0) + slope_to(q, c, g->right[c], 1) +
                             slope_to(q, c, g->down[c], 2) + slope_to(q, c, g->up[c], 3));
        }
    }
}

void pl_liquid_diffuse(pl_liquid_grid *g, double amount)
{
    const double wanted = amount / MOST_A_SWEEP;
    const int sweeps = wanted >= MOST_SWEEPS ? MOST_SWEEPS : 1 + (int)wanted;
    const double most = MOST_A_SWEEP * sweeps;
    const near_real k = (near_real)((amount < most ? amount : most) / sweeps);
    for (int i = 0; i < sweeps; ++i) {
        const component x = { g->u, g->open_u, g->solid_u, g->known_u, g->new_u, 2 };
        const component y = { g->v, g->open_v, g->solid_v, g->known_v, g->new_v, 0 };
        sweep(g, &x, k);
        sweep(g, &y, k);
        near_real *u = g->u, *v = g->v;
        g->u = g->new_u, g->new_u = u;
        g->v = g->new_v, g->new_v = v;
    }
}
