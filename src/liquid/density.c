// density.c - the liquid's volume where velocities have lost it: particles are moved until they lie evenly.
//
// A velocity field without divergence still lets particles gather, step by step; what is lost so is found in their
// places alone. The density at a cell's centre is a sum of hats over particles, and solid counts as full of them; the
// excess e over that of rest is sent away by displacements d = -grad f, with the matrix of the pressures:
// sum a (f - f_beside) = e. Velocities do not change (after Kugelstadt et al. 2019). Too little is filled up only in
// cells that no air is beside: a surface is thin by itself.
//
// Reads: points, openness, rows. Writes: new_u, new_v, vectors. Cost: O(9 points + rows x iterations).
#include "liquid/liquid.h"

#define MOST_EXCESS  ((near_real)0.5)
#define MOST_WAY     ((near_real)0.5) // cells
#define SOLVE_TO     1e-2
#define HALF         ((near_real)0.5)
#define OWN_SHARE    ((near_real)0.75) // of a hat over cells: its own, those beside it
#define BESIDE_SHARE ((near_real)0.125)

// The hat of a centre at (x, y) from the corner of cell c, over its points.
static near_real hats(const pl_liquid_grid *g, uint32_t c, near_real x, near_real y)
{
    near_real total = 0;
    for (uint32_t k = g->first[c]; k < g->first[c + 1]; ++k) {
        const near_real dx = x - g->points[k].fx, dy = y - g->points[k].fy;
        const near_real wx = 1 - (dx < 0 ? -dx : dx), wy = 1 - (dy < 0 ? -dy : dy);
        total += wx > 0 && wy > 0 ? wx * wy : 0;
    }
    return total;
}

static near_real solid_hat(const pl_liquid_grid *g, uint32_t c)
{
    const uint32_t l = g->left[c], r = g->right[c], d = g->down[c], u = g->up[c];
    const near_real *s = g->cover;
    const near_real sides = s[l] + s[r] + s[d] + s[u];
    const near_real corners = s[g->left[d]] + s[g->right[d]] + s[g->left[u]] + s[g->right[u]];
    return OWN_SHARE * OWN_SHARE * s[c] + OWN_SHARE * BESIDE_SHARE * sides +
           BESIDE_SHARE * BESIDE_SHARE * corners;
}

static near_real density_at(const pl_liquid_grid *g, uint32_t c)
{
    const uint32_t d = g->down[c], u = g->up[c];
    const near_real h = HALF, before = 1 + HALF, behind = -HALF;
    const near_real total =
        hats(g, c, h, h) + hats(g, g->left[c], before, h) + hats(g, g->right[c], behind, h) +
        hats(g, d, h, before) + hats(g, u, h, behind) + hats(g, g->left[d], before, before) +
        hats(g, g->right[d], behind, before) + hats(g, g->left[u], before, behind) +
        hats(g, g->right[u], behind, behind);
    return total / PL_LIQUID_FULL;
}

void pl_liquid_weigh(pl_liquid_grid *g)
{
    for (uint32_t c = 1; c < g->cell_count; ++c) {
        g->solid[c] = solid_hat(g, c);
        g->density[c] = density_at(g, c) + g->solid[c];
    }
}

static near_real excess(const pl_liquid_grid *g, const pl_liquid_row *row)
{
    near_real e = g->density[row->cell] - 1;
    e = e > MOST_EXCESS ? MOST_EXCESS : e < -MOST_EXCESS ? -MOST_EXCESS : e;
    if (e < 0) {
        for (int k = 0; k < 4; ++k) {
            e = row->next[k] == g->row_count && row->open[k] > 0 ? 0 : e;
        }
    }
    return e;
}

static near_real potential(const pl_liquid_grid *g, uint32_t c)
{
    return c == 0 || g->row[c] == PL_LIQUID_NONE ? 0 : g->vectors[PL_LIQUID_P][g->row[c]];
}

static near_real held(near_real way)
{
    return way > MOST_WAY ? MOST_WAY : way < -MOST_WAY ? -MOST_WAY : way;
}

void pl_liquid_even_out(pl_liquid_grid *g)
{
    near_real *r = g->vectors[PL_LIQUID_R];
    for (uint32_t i = 0; i < g->row_count; ++i) {
        r[i] = excess(g, &g->rows[i]);
    }
    pl_liquid_solve(g, 0, SOLVE_TO);
    for (uint32_t c = 0; c < g->cell_count; ++c) {
        const uint32_t left = g->left[c], down = g->down[c];
        const bool here = g->row[c] != PL_LIQUID_NONE;
        const bool u = here || g->row[left] != PL_LIQUID_NONE;
        const bool v = here || g->row[down] != PL_LIQUID_NONE;
        g->known_u[c] = c != 0 && u;
        g->known_v[c] = c != 0 && v;
        const near_real over_u = potential(g, left) - potential(g, c);
        const near_real over_v = potential(g, down) - potential(g, c);
        g->new_u[c] = u && g->open_u[c] > 0 ? held(over_u / pl_liquid_gap(g, left, c)) : 0;
        g->new_v[c] = v && g->open_v[c] > 0 ? held(over_v / pl_liquid_gap(g, down, c)) : 0;
    }
    g->new_u[0] = g->new_v[0] = 0;
    pl_liquid_extrapolate(g, g->new_u, g->new_v, 1);
}
